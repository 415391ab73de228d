// The WebSocket: subscribes by topic and reconnects by itself.

const SUBPROTOCOLS = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
const PAUSE_MS = 1000; // between attempts
const PATIENCE_MS = 4000; // of one attempt
const MESSAGE_DATA = 1;
const CALL = 2;
const RESPONSE = 3;
const ENCODING = new TextEncoder().encode("json");

/** Adds the token of the page's address to another path of this server. */
export function withToken(path) {
  const token = new URLSearchParams(location.search).get("token");
  return token ? `${path}?token=${encodeURIComponent(token)}` : path;
}

export class Connection {
  /** handlers: {topic: (payload, timeNs) => void}. JSON payloads arrive parsed, others as Uint8Array. */
  constructor(handlers, onState) {
    this.handlers = handlers;
    this.onState = onState;
    this.receivedBytes = 0;
    this.nextCall = 1;
    this.connect();
  }

  connect() {
    this.channels = new Map(); // by id; subscriptions have the id of their channel
    this.services = new Map(); // ids by name
    this.calls = new Map(); // by id: {done, failed}
    const scheme = location.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(`${scheme}//${location.host}${withToken("/")}`, SUBPROTOCOLS);
    socket.binaryType = "arraybuffer";
    const givesUp = setTimeout(() => socket.close(), PATIENCE_MS);
    socket.onopen = () => {
      clearTimeout(givesUp);
      this.onState("open");
    };
    socket.onmessage = (event) => this.take(event.data, socket);
    socket.onclose = () => {
      clearTimeout(givesUp);
      this.onState("closed");
      for (const { failed } of this.calls.values()) failed(new Error("disconnected"));
      setTimeout(() => this.connect(), PAUSE_MS);
    };
    this.socket = socket;
  }

  take(data, socket) {
    if (typeof data === "string") {
      const message = JSON.parse(data);
      if (message.op === "advertise") this.subscribe(message.channels, socket);
      if (message.op === "advertiseServices") for (const { id, name } of message.services) this.services.set(name, id);
      if (message.op === "serviceCallFailure") this.end(message.callId)?.failed(new Error(message.message));
      return;
    }
    this.receivedBytes += data.byteLength;
    const view = new DataView(data);
    if (view.getUint8(0) === RESPONSE) return void this.end(view.getUint32(5, true))?.done();
    if (view.getUint8(0) !== MESSAGE_DATA) return;
    const channel = this.channels.get(view.getUint32(1, true));
    if (!channel) return;
    const payload = new Uint8Array(data, 13);
    const content = channel.encoding === "json" ? JSON.parse(new TextDecoder().decode(payload)) : payload;
    this.handlers[channel.topic](content, view.getBigUint64(5, true));
  }

  end(id) {
    const call = this.calls.get(id);
    this.calls.delete(id);
    return call;
  }

  /** Calls a service of the server: a promise. */
  call(name, request) {
    const service = this.services.get(name);
    if (service === undefined || this.socket.readyState !== WebSocket.OPEN) return Promise.reject(new Error("not connected"));
    const payload = new TextEncoder().encode(JSON.stringify(request));
    const bytes = new Uint8Array(13 + ENCODING.length + payload.length);
    const view = new DataView(bytes.buffer);
    const id = this.nextCall++;
    view.setUint8(0, CALL);
    [service, id, ENCODING.length].forEach((number, i) => view.setUint32(1 + 4 * i, number, true));
    bytes.set(ENCODING, 13);
    bytes.set(payload, 13 + ENCODING.length);
    this.socket.send(bytes);
    return new Promise((done, failed) => this.calls.set(id, { done, failed }));
  }

  subscribe(channels, socket) {
    const wanted = channels.filter((channel) => channel.topic in this.handlers);
    for (const channel of wanted) this.channels.set(channel.id, channel);
    const subscriptions = wanted.map((channel) => ({ id: channel.id, channelId: channel.id }));
    socket.send(JSON.stringify({ op: "subscribe", subscriptions }));
  }
}
