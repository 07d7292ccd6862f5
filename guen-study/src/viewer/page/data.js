// The JSON that the exporter writes, and how its samples become typed arrays.

/** Bytes out of base64. */
function bytesOf(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let k = 0; k < letters.length; k += 1) bytes[k] = letters.charCodeAt(k);
  return bytes;
}

/** Samples: base64, or what names the parts of the page where they are. */
function unpack(stored) {
  if (typeof stored === "string") return bytesOf(stored);
  const all = new Uint8Array(stored.bytes);
  let at = 0;
  for (let k = stored.from; k < stored.to; k += 1) {
    const element = document.getElementById(`part-${k}`);
    const part = bytesOf(element.textContent);
    // The text is not needed any more.
    element.remove();
    all.set(part, at);
    at += part.length;
  }
  return all;
}

/** Whether this machine orders bytes as the file does: the least significant one first. */
const littleEndian = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;

/** Numbers of `size` bytes each. */
function decode(stored, size = 4) {
  const bytes = unpack(stored);
  if (!littleEndian) for (let k = 0; k < bytes.length; k += size) bytes.subarray(k, k + size).reverse();
  return size === 8 ? new Float64Array(bytes.buffer) : new Float32Array(bytes.buffer);
}

const motion = JSON.parse(document.getElementById("motion").textContent);
/** A name that may be written from right to left, or says so, in marks that keep its direction from what stands beside it. */
const isolated = (name) => (/[\u0590-\u08ff\u200e\u200f\u202a-\u202e\u2066-\u2069\ufb1d-\ufdff\ufe70-\ufefc]|[\ud802-\ud803\ud83a-\ud83b]/.test(name) ? `\u2068${name}\u2069` : name);
