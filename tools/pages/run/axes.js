// Ticks of an axis at multiples of 1, 2 or 5 times a power of ten.
steplap.axes = (() => {
  // Returns { values, step } with at most `most` ticks from low to high, but at least three.
  function ticks(low, high, most) {
    if (!(high > low)) return { values: [low], step: Math.abs(low) || 1 };
    const from = Math.floor(Math.log10(high - low)) - 3;
    let finer = null;
    for (let k = 0; k < 15; ++k) {
      const step = [1, 2, 5][k % 3] * 10 ** (from + Math.floor(k / 3));
      const begin = Math.ceil(low / step - 1e-9), end = Math.floor(high / step + 1e-9), count = end - begin + 1;
      if (count < 3 && finer) return finer;
      if (count > 1000) continue;
      finer = { step, values: Array.from({ length: count }, (_, i) => (begin + i) * step) };
      if (count <= most) return finer;
    }
    return finer;
  }
  // Formats a tick with the decimals of the step: 0.05, 0.10.
  function label(value, step) {
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const size = Math.max(Math.abs(value), step);
    if (size >= 1e7 || decimals > 7)
      return (Math.abs(value) < 1e-9 * step
          ? '0'
          : value.toExponential(Math.max(0, Math.ceil(Math.log10(size / step)))).replace(/-/g, '−').replace('e+', 'e'));
    const text = value.toFixed(decimals);
    if (Number(text) === 0) return '0';
    return text.replace('-', '−');
  }
  return { ticks, label };
})();
