// A display's frame, as the server's rviz/drawing.py writes it.

const KINDS = { f4: Float32Array, u1: Uint8Array };

/** `{number, parts}`; a part has `kind`, `pose`, `key`, its fields, and `arrays` by name. */
export function decodeFrame(data) {
  const number = data.getUint32(0, true);
  const length = data.getUint32(4, true);
  const text = new Uint8Array(data.buffer, data.byteOffset + 8, length);
  const start = data.byteOffset + 8 + length;
  const parts = JSON.parse(new TextDecoder().decode(text));
  for (const part of parts) {
    for (const [name, [kind, at, count]] of Object.entries(part.arrays ?? {})) {
      part.arrays[name] = new KINDS[kind](data.buffer, start + at, count);
    }
  }
  return { number, parts };
}
