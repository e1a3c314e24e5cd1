// Writes the motion as an animated PNG (APNG; PNG specification, third edition, section 11.3.2): frames are drawn like the PNG of the
// picture, and the browser compresses each. Every browser plays the file, in a loop.
steplap.animation = (() => {
  const rate = 20, most = 200, least = 10; // frames per second; largest and smallest number of frames
  const signature = [137, 80, 78, 71, 13, 10, 26, 10];

  const table = Uint32Array.from({ length: 256 }, (_, n) => {
    let c = n;
    for (let k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
    return c;
  });
  const crc = (bytes) => (bytes.reduce((c, b) => table[(c ^ b) & 255] ^ (c >>> 8), 0xffffffff) ^ 0xffffffff) >>> 0;
  // Returns numbers as bytes, most significant first. The argument is a list of [value, number of bytes].
  const bytesOf = ([v, n]) => Array.from({ length: n }, (_, k) => (v >>> (8 * (n - 1 - k))) & 255);
  const packed = (...values) => Uint8Array.from(values.flatMap(bytesOf));
  function joined(parts) {
    const all = new Uint8Array(parts.reduce((sum, p) => sum + p.length, 0));
    let at = 0;
    for (const p of parts) {
      all.set(p, at);
      at += p.length;
    }
    return all;
  }
  function chunk(type, data) {
    const body = joined([Uint8Array.from(type, (c) => c.charCodeAt(0)), data]);
    return joined([packed([data.length, 4]), body, packed([crc(body), 4])]);
  }
  // Splits a PNG file into its chunks, [{ type, data }].
  function chunksOf(png) {
    const view = new DataView(png.buffer, png.byteOffset), found = [];
    for (let at = signature.length; at < png.length; at += 12 + view.getUint32(at)) {
      const begin = at + 8, type = String.fromCharCode(...png.subarray(at + 4, begin));
      found.push({ type, data: png.subarray(begin, begin + view.getUint32(at)) });
    }
    return found;
  }
  // Returns an animated PNG of frames of equal size, each shown for `delay` ms.
  function assembled(frames, delay) {
    const all = frames.map(chunksOf), header = all[0].find((c) => c.type === 'IHDR').data, size = header.subarray(0, 8);
    const parts = [Uint8Array.from(signature), chunk('IHDR', header), chunk('acTL', packed([frames.length, 4], [0, 4]))];
    let number = 0;
    const shown =
      packed([0, 4], [0, 4], [delay, 2], [1000, 2], [0, 1], [0, 1]); // offset (0, 0); shown for delay/1000 s; replaces the previous frame
    all.forEach((chunks, k) => {
      parts.push(chunk('fcTL', joined([packed([number++, 4]), size, shown])));
      for (const { data } of chunks.filter((c) => c.type === 'IDAT'))
        parts.push(k ? chunk('fdAT', joined([packed([number++, 4]), data])) : chunk('IDAT', data));
    });
    return joined([...parts, chunk('IEND', new Uint8Array())]);
  }
  // Returns the instants of the frames and the time for which each is shown, for a run of `end` seconds played at `speed` times real time.
  function frames(end, speed) {
    const seconds = end / speed, count = Math.round(Math.min(most, Math.max(least, rate * seconds)));
    const delay = Math.max(1, Math.min(65535, Math.round((1000 * seconds) / count))); // ms; the format stores 16 bits
    return { times: Array.from({ length: count }, (_, k) => (end * k) / (count - 1)), delay };
  }
  // Draws `scene` at each of its instants and saves the file. Calls `onFrame(done, all)` after each frame.
  async function save(scene, name, end, speed, onFrame) {
    const { times, delay } = frames(end, speed), pictures = [];
    for (const t of times) {
      scene.show(t);
      const canvas = await steplap.onPaper(() => steplap.save.raster(scene.svg, 1));
      const blob = await new Promise((done) => { canvas.toBlob(done, 'image/png'); });
      pictures.push(new Uint8Array(await blob.arrayBuffer()));
      onFrame(pictures.length, times.length);
    }
    steplap.save.file(`${name}_motion.png`, 'image/apng', assembled(pictures, delay));
  }
  return { save, frames };
})();
