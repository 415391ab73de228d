// Reads the two protobuf messages that the page needs: foxglove.PointCloud and foxglove.PosesInFrame.

/** Calls on(field, value) for each field: value is a number, or a Uint8Array of a nested message or of bytes. */
export function readFields(bytes, on) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let at = 0;
  const varint = () => {
    let value = 0;
    for (let factor = 1; ; factor *= 128) {
      const byte = bytes[at++];
      value += (byte & 127) * factor;
      if (byte < 128) return value;
    }
  };
  while (at < bytes.length) {
    const key = varint();
    const field = Math.floor(key / 8);
    switch (key % 8) {
      case 0:
        on(field, varint());
        break;
      case 1:
        on(field, view.getFloat64(at, true));
        at += 8;
        break;
      case 2: {
        const length = varint();
        on(field, bytes.subarray(at, at + length));
        at += length;
        break;
      }
      case 5:
        on(field, view.getUint32(at, true));
        at += 4;
        break;
      default:
        throw new Error("not a protobuf message");
    }
  }
}

/** Points of a labelled scan: {count, data}, data as laid out by scan_messages.hpp (16 bytes a point). */
export function readPoints(bytes) {
  let data = new Uint8Array(0);
  readFields(bytes, (field, value) => {
    if (field === 6) data = value;
  });
  return { count: data.length / 16, data: data.slice() }; // aligned
}

/** [x, y] of each pose, flat. */
export function readPositions(bytes) {
  const positions = [];
  const readPosition = (position) => {
    const at = [0, 0];
    readFields(position, (field, value) => {
      if (field === 1 || field === 2) at[field - 1] = value;
    });
    positions.push(at[0], at[1]);
  };
  readFields(bytes, (field, pose) => {
    if (field !== 3) return;
    readFields(pose, (part, position) => {
      if (part === 1) readPosition(position);
    });
  });
  return positions;
}
