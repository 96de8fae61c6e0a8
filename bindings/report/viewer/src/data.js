// The arrays of a run. bindings/cli/report_arrays.c writes them: differences to the value one `stride`
// earlier, signs folded into the lowest bit, the four bytes of all values in four planes, deflated,
// base64.

async function inflate(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = binary.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function decode(bytes, offset, count, stride) {
  const values = new Int32Array(count);
  const [b0, b1, b2, b3] = [0, 1, 2, 3].map((k) => bytes.subarray(offset + k * count, offset + (k + 1) * count));
  for (let i = 0; i < count; i++) {
    const folded = b0[i] | (b1[i] << 8) | (b2[i] << 16) | (b3[i] << 24);
    const difference = (folded >>> 1) ^ -(folded & 1);
    values[i] = i < stride ? difference : (difference + values[i - stride]) | 0;
  }
  return values;
}

// {name: Int32Array} by the list of {name, count, stride}, in the order of the list.
export async function readArrays(list, text) {
  const bytes = await inflate(text);
  const arrays = {};
  let offset = 0;
  for (const { name, count, stride } of list) {
    arrays[name] = decode(bytes, offset, count, stride);
    offset += 4 * count;
  }
  if (offset !== bytes.length) throw new Error(`${bytes.length} bytes of geometry, not ${offset}`);
  return arrays;
}
