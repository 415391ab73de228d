"""Viewers of the gateway that are cheap enough not to disturb what is measured: plain sockets, in one thread of their own. Good ones
read everything and look at nothing."""

import base64
import json
import os
import selectors
import socket
import struct
import threading
import time

CHURN_PERIOD_S = 0.05
NOISE_PERIOD_S = 0.1


def text_frame(text):
    """A WebSocket frame from a client, masked with zeros."""
    payload = text.encode()
    assert 126 <= len(payload) < 65536
    return struct.pack(">BBH4x", 0x81, 0x80 | 126, len(payload)) + payload


def connect(port, receive_bytes=None):
    """A socket with a WebSocket on it, subscribed to all channels."""
    link = socket.socket()
    if receive_bytes:
        link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_bytes)
    link.settimeout(10)
    link.connect(("127.0.0.1", port))
    key = base64.b64encode(os.urandom(16)).decode()
    link.sendall((f"GET / HTTP/1.1\r\nHost: localhost:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: {key}\r\n"
                  "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: foxglove.websocket.v1\r\n\r\n").encode())
    assert link.recv(12) == b"HTTP/1.1 101"
    subscriptions = [{"id": 100 + channel, "channelId": channel} for channel in range(14)]
    link.sendall(text_frame(json.dumps({"op": "subscribe", "subscriptions": subscriptions})))
    return link


class Crowd:
    """So many good viewers, one that reads nothing, one that sends random bytes, and one that comes and goes all the time."""

    def __init__(self, port, good=17):
        self.port = port
        self.good = good
        self.received = [0] * good
        self.visits = 0
        self.noise = 0
        self.is_over = threading.Event()

    def __enter__(self):
        self.selector = selectors.DefaultSelector()
        self.links = [connect(self.port) for _ in range(self.good)]
        for number, link in enumerate(self.links):
            link.setblocking(False)
            self.selector.register(link, selectors.EVENT_READ, number)
        self.stalled = connect(self.port, receive_bytes=4096)
        self.threads = [threading.Thread(target=work) for work in (self.read, self.send_noise, self.come_and_go)]
        for thread in self.threads:
            thread.start()
        return self

    def __exit__(self, *_):
        self.is_over.set()
        for thread in self.threads:
            thread.join(20)
        for link in [*self.links, self.stalled]:
            link.close()

    def read(self):
        while not self.is_over.is_set():
            for ready, _ in self.selector.select(0.1):
                self.received[ready.data] += len(ready.fileobj.recv(1 << 20))

    def send_noise(self):
        while not self.is_over.wait(NOISE_PERIOD_S):
            try:
                noisy = connect(self.port)
                while not self.is_over.wait(NOISE_PERIOD_S):
                    noisy.sendall(os.urandom(2000))
                    self.noise += 1
            except OSError:
                continue  # disconnected, as it deserves

    def come_and_go(self):
        while not self.is_over.wait(CHURN_PERIOD_S):
            try:
                connect(self.port).close()
                self.visits += 1
            except OSError:
                time.sleep(CHURN_PERIOD_S)
