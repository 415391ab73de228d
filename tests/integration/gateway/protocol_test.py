"""An independent client (websockets and protobuf, nothing of ours) reads every channel; bad clients harm nobody.

Usage: protocol_test.py SLAMMOT. Skipped (77) where the two packages are missing.
"""

import asyncio
import base64
import json
import os
import socket
import struct
import sys
import time
import unittest

try:
    import websockets
    from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
except ImportError as fault:
    print(f"skipped: {fault}; Debian's python3-websockets and python3-protobuf are needed")
    sys.exit(77)

from live import Live

PATIENCE_S = 60
RARE = {"/log", "/gnss"}  # only where something warns, or a receiver is on board


def message_class(channel):
    """Built from nothing but the schema that the server advertises."""
    files = descriptor_pb2.FileDescriptorSet.FromString(base64.b64decode(channel["schema"]))
    pool = descriptor_pool.DescriptorPool()
    for file in files.file:
        pool.Add(file)
    return message_factory.MessageFactory(pool).GetPrototype(pool.FindMessageTypeByName(channel["schemaName"]))


class Client:
    def __init__(self, address):
        self.address = address
        self.messages = {}  # topic: last decoded message
        self.counts = {}

    async def __aenter__(self):
        self.socket = await websockets.connect(self.address, subprotocols=["foxglove.websocket.v1"], max_size=None)
        self.info = json.loads(await self.socket.recv())
        advertised = json.loads(await self.socket.recv())["channels"]
        self.channels = {channel["id"]: channel for channel in advertised}
        self.classes = {c["id"]: message_class(c) for c in advertised if c["encoding"] == "protobuf"}
        return self

    async def __aexit__(self, *_):
        await self.socket.close()

    async def subscribe(self, topics):
        wanted = [channel["id"] for channel in self.channels.values() if channel["topic"] in topics]
        subscriptions = [{"id": 100 + id, "channelId": id} for id in wanted]
        await self.socket.send(json.dumps({"op": "subscribe", "subscriptions": subscriptions}))

    async def read_until(self, is_done):
        end = time.monotonic() + PATIENCE_S
        while not is_done():
            message = await asyncio.wait_for(self.socket.recv(), max(0.1, end - time.monotonic()))
            if isinstance(message, bytes):
                self.take(message)

    def take(self, message):
        opcode, subscription, time_ns = struct.unpack_from("<BIQ", message)
        assert opcode == 1 and time_ns > 0
        channel = self.channels[subscription - 100]
        payload = message[13:]
        is_json = channel["encoding"] == "json"
        decoded = json.loads(payload) if is_json else self.classes[channel["id"]].FromString(payload)
        self.messages[channel["topic"]] = decoded
        self.counts[channel["topic"]] = self.counts.get(channel["topic"], 0) + 1


class Gateway(unittest.IsolatedAsyncioTestCase):
    @classmethod
    def setUpClass(cls):
        cls.live = Live(SLAMMOT)
        cls.live.wait_until_ready()
        cls.address = f"ws://127.0.0.1:{cls.live.port}/"

    @classmethod
    def tearDownClass(cls):
        cls.live.__exit__()

    async def test_every_channel_is_decoded_with_the_advertised_schema(self):
        async with Client(self.address) as client:
            self.assertEqual("foxglove.websocket.v1", client.socket.subprotocol)
            self.assertEqual("serverInfo", client.info["op"])
            topics = {channel["topic"] for channel in client.channels.values()} - RARE
            await client.subscribe(topics)
            await client.read_until(lambda: topics <= client.messages.keys())
            points = client.messages["/scan/points"]
            self.assertEqual(0, len(points.data) % points.point_stride)
            grid = client.messages["/map/stationary"]
            self.assertEqual(0, len(grid.data) % grid.row_stride)
            self.assertEqual({"map", "odom"}, {t.parent_frame_id for t in client.messages["/tf"].transforms[:2]})
            names = {service["service"] for service in client.messages["/slammot/health"]["services"]}
            self.assertLessEqual({"localization", "detection", "tracking"}, names)

    async def test_a_submap_is_served_compressed(self):
        async with Client(self.address) as client:
            await client.subscribe({"/slammot/graph"})
            await client.read_until(lambda: client.messages.get("/slammot/graph", {}).get("submaps"))
            submap = client.messages["/slammot/graph"]["submaps"][0]
        status, body = self.live.get(submap["path"])
        self.assertEqual((200, b"\x1f\x8b"), (status, body[:2]))

    async def test_bad_clients_harm_nobody(self):
        async with Client(self.address) as good, Client(self.address) as confused:
            await good.subscribe({"/slammot/pose"})
            stalled = socket.create_connection(("127.0.0.1", self.live.port))  # says nothing
            noisy = socket.create_connection(("127.0.0.1", self.live.port))
            noisy.sendall(os.urandom(20000))
            for number in range(50):
                await confused.socket.send(os.urandom(200) if number % 2 else "{" * 50)
            await good.read_until(lambda: good.counts.get("/slammot/pose", 0) > 50)
            stalled.close()
            noisy.close()
        self.assertEqual((200, b"alive\n"), self.live.get("/healthz"))
        metrics = self.live.get("/metrics")[1].decode()
        refused = [line for line in metrics.splitlines() if line.startswith("slammot_gateway_refused_messages_total")]
        self.assertGreaterEqual(float(refused[0].split()[-1]), 0)

    async def test_pages_of_other_servers_are_refused(self):
        self.assertEqual(403, self.live.get("/metrics", {"Origin": "https://evil.example.org"})[0])
        self.assertEqual(403, self.live.get("/metrics", {"Host": "evil.example.org"})[0])
        with self.assertRaises(websockets.exceptions.InvalidStatusCode):
            await websockets.connect(self.address, subprotocols=["foxglove.sdk.v1"], origin="https://evil.example.org")

    def test_metrics_are_in_prometheus_format(self):
        status, body = self.live.get("/metrics")
        self.assertEqual(200, status)
        for line in body.decode().splitlines():
            self.assertRegex(line, r'^(# (HELP|TYPE) [a-z_]+ .+|[a-z_]+(\{.*\})? -?[0-9.e+-]+|[a-z_]+(\{.*\})? (Nan|\+Inf))$')
        self.assertIn('slammot_service_up{service="tracking"', body.decode())


if __name__ == "__main__":
    SLAMMOT = sys.argv.pop(1)
    unittest.main()
