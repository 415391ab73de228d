// The WebSocket: subscribes by topic and reconnects by itself.

const SUBPROTOCOLS = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
const PAUSE_MS = 1000; // between attempts
const PATIENCE_MS = 4000; // of one attempt
const MESSAGE_DATA = 1;

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
    this.connect();
  }

  connect() {
    this.channels = new Map(); // by id; subscriptions have the id of their channel
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
      setTimeout(() => this.connect(), PAUSE_MS);
    };
    this.socket = socket;
  }

  take(data, socket) {
    if (typeof data === "string") {
      const message = JSON.parse(data);
      if (message.op === "advertise") this.subscribe(message.channels, socket);
      return;
    }
    this.receivedBytes += data.byteLength;
    const view = new DataView(data);
    if (view.getUint8(0) !== MESSAGE_DATA) return;
    const channel = this.channels.get(view.getUint32(1, true));
    if (!channel) return;
    const payload = new Uint8Array(data, 13);
    const content = channel.encoding === "json" ? JSON.parse(new TextDecoder().decode(payload)) : payload;
    this.handlers[channel.topic](content, view.getBigUint64(5, true));
  }

  subscribe(channels, socket) {
    const wanted = channels.filter((channel) => channel.topic in this.handlers);
    for (const channel of wanted) this.channels.set(channel.id, channel);
    const subscriptions = wanted.map((channel) => ({ id: channel.id, channelId: channel.id }));
    socket.send(JSON.stringify({ op: "subscribe", subscriptions }));
  }
}
