/** Reads what `packed_frames` and `deflated` have packed for a saved page. */

/** The bytes of a raw deflate stream in base64. */
export async function inflated(base64) {
    const packed = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The frames one after another, from the planes of their differences. */
export function unpackedFrames(planes, frameBytes) {
    const columns = frameBytes / 4;
    const count = planes.length / 4;
    const rows = columns ? count / columns : 0;
    const numbers = new Uint32Array(count);
    for (let column = 0; column < columns; column++) {
        let before = 0;
        for (let row = 0; row < rows; row++) {
            const at = column * rows + row;
            const change =
                planes[at] | (planes[count + at] << 8) | (planes[2 * count + at] << 16) | (planes[3 * count + at] << 24);
            before = (before + change) >>> 0;
            numbers[row * columns + column] = before;
        }
    }
    return numbers.buffer;
}

/** Pieces of these lengths, one after another. */
export function pieces(bytes, lengths) {
    let end = 0;
    return lengths.map((length) => bytes.subarray(end, (end += length)));
}
