// Formats numbers for readers: three digits, four if the first is a 1, and never more than the error allows. An error is written only if it
// affects a displayed digit or reaches the limit. All digits are kept in `full`, for titles and files.
steplap.numbers = (() => {
  const { scaleFor, pretty } = steplap.data;
  const space = '\u00a0';

  // Returns the number of decimals for a number of this magnitude.
  function decimalsOf(size) {
    if (!(size > 0) || !isFinite(size)) return 0;
    const exponent = Math.floor(Math.log10(size) + 1e-12), digits = size / 10 ** exponent < 2 ? 4 : 3;
    return Math.max(0, digits - 1 - exponent);
  }
  // Returns the decimal place of the first digit of an error, rounded up: 0.0096 is written as 0.01.
  const placeOf = (error) => -Math.floor(Math.log10(error) + 0.0223); // log10(1/0.95): 9.5 and more are rounded up to 10
  const signed = (text) => text.replace('-', '−');

  // Formats with fixed decimals, without trailing zeros. Digits of large numbers are grouped by three.
  function fixed(value, decimals) {
    const size = Math.abs(value);
    if (size >= 1e7 || (size > 0 && decimals > 7)) return signed(value.toExponential(2));
    let text = value.toFixed(Math.min(20, decimals));
    if (Number(text) === 0) return '0';
    if (text.includes('.')) text = text.replace(/\.?0+$/, '');
    if (size >= 1e4) text = text.replace(/\B(?=(\d{3})+(?!\d))/g, space);
    return signed(text);
  }
  // Formats an error with one digit, rounded up, so that it is never understated.
  function errorText(error) {
    const step = 10 ** -placeOf(error), digits = Math.ceil(error / step - 1e-9);
    return fixed(digits * step, Math.max(0, placeOf(error)));
  }
  const isKnown = (value) => value !== null && value !== undefined && !Number.isNaN(value);
  const isError = (error) => isKnown(error) && isFinite(error) && error > 0;

  // Formats a number that is in its final unit, with at most the given number of decimals.
  function measured(value, decimals, error, limit) {
    if (!isKnown(value)) return '–';
    if (!isFinite(value)) return value > 0 ? '∞' : '−∞';
    if (!isError(error)) return fixed(value, decimals);
    const isAtLimit = isKnown(limit) && Math.abs(Math.abs(value) - Math.abs(limit)) <= error;
    if (!isAtLimit && error < 0.5 * 10 ** -decimals) return fixed(value, decimals);
    const places = isAtLimit ? Math.max(decimals, placeOf(error)) : Math.min(decimals, placeOf(error));
    const step = 10 ** Math.max(0, -places);
    return `${fixed(step > 1 ? Math.round(value / step) * step : value, Math.max(0, places))} ± ${errorText(error)}`;
  }

  // Size of rounding errors per unit: 1e-9 of the largest value in the run. For lengths it is 5e-6 of the largest one, at most 0.5 µm; for
  // angles at least 1e-10 rad, which is 0.01 µm at 100 m.
  const roundings = new WeakMap();
  function largestOf(run, unit) {
    let largest = 0;
    for (const e of Object.values(run.summary.extremes))
      if (e.unit === unit)
        for (const v of [e.min, e.max])
          if (isKnown(v) && isFinite(v)) largest = Math.max(largest, Math.abs(v));
    return largest;
  }
  function roundingOf(run, unit) {
    if (!roundings.has(run)) roundings.set(run, new Map());
    const known = roundings.get(run);
    if (!known.has(unit)) {
      let largest = largestOf(run, unit);
      if (unit === 'N m')
        // couples: largest force times largest length, at most 1 m
        largest = Math.max(largest, largestOf(run, 'N') * Math.min(1, largestOf(run, 'm')));
      known.set(unit, unit === 'm' ? Math.min(5e-7, 5e-6 * largest) : unit === 'rad' ? Math.max(1e-10, 1e-9 * largest) : 1e-9 * largest);
    }
    return known.get(unit);
  }
  // Returns the smallest rounding error over all compared runs.
  const roundingIn = (runs, unit) => Math.min(...runs.map((run) => roundingOf(run, unit)));
  // Returns true if a channel contains rounding errors only, during the whole run.
  function isRounding(run, name) {
    const e = run.summary.extremes[name];
    if (!e || !isKnown(e.min) || !isKnown(e.max)) return false;
    return Math.max(Math.abs(e.min), Math.abs(e.max)) <=
      Math.max(roundingOf(run, e.unit || ''), Math.min(e.error_min || 0, e.error_max || 0));
  }

  // Formats several numbers with one unit and prefix: { unit, texts }. `entries`: { value, error, limit }.
  function column(entries, unit, rounding = 0) {
    const sizes = entries.map((e) => Math.abs(e.value)).filter((v) => isFinite(v) && v > rounding);
    const largest = sizes.length ? Math.max(...sizes) : 0;
    const scale = largest > 0 ? scaleFor(unit || '', largest) : { factor: 1, unit: pretty(unit || '') };
    const most = decimalsOf(largest * scale.factor) + 1;
    const texts = entries.map(({ value, error, limit }) => {
      if (isKnown(value) && Math.abs(value) <= rounding) return '0';
      const size = Math.abs(value) * scale.factor;
      return measured(isKnown(value) ? value * scale.factor : value, Math.min(most, decimalsOf(size)),
        isError(error) ? error * scale.factor : error, isKnown(limit) ? limit * scale.factor : limit);
    });
    return { unit: scale.unit, factor: scale.factor, texts };
  }
  const withUnit = (text, unit) =>
    (unit && text !== '–' ? (text.includes('±') ? `(${text})${space}${unit}` : `${text}${space}${unit}`) : text);
  // Formats one number with its unit and prefix.
  function one(value, unit, { error, limit, rounding = 0 } = {}) {
    const found = column([{ value, error, limit }], unit, rounding);
    return withUnit(found.texts[0], found.unit);
  }
  // Formats a number in a given unit { factor, unit }, such as that of an axis.
  function onScale(value, scale, { error, rounding = 0 } = {}) {
    if (isKnown(value) && Math.abs(value) <= rounding) return withUnit('0', scale.unit);
    return withUnit(measured(isKnown(value) ? value * scale.factor : value, decimalsOf(Math.abs(value) * scale.factor),
                      isError(error) ? error * scale.factor : error),
      scale.unit);
  }
  // Formats a time with a resolution of 1e-4 of the run, or of its error. Returns '–' if the error exceeds 2 % of the run, as for the
  // maximum of a flat curve.
  function instant(t, end, error) {
    if (!isKnown(t) || (isError(error) && error > end / 50)) return '–';
    const isShort = end < 0.01, decimals = Math.max(0, 4 - Math.ceil(Math.log10((isShort ? 1000 : 1) * end) - 1e-9));
    const k = isShort ? 1000 : 1;
    return withUnit(measured(k * t, decimals, isError(error) ? k * error : error), isShort ? 'ms' : 's');
  }
  // Formats a utilisation as a percentage. "100 %" is only written for values at the limit.
  function percent(share, error) {
    if (!isKnown(share)) return '–';
    if (!isFinite(share)) return '∞';
    if (share >= 1000) return `>${space}1000${space}%`; // without capacity the number has no meaning (run/utilisation.h)
    const isAtLimit = Math.abs(share - 1) < 1e-9; // sliding friction, within rounding errors
    const value = isAtLimit ? 100 : 100 * share;
    let decimals = value < 9.95 ? 1 : 0;
    while (!isAtLimit && Number(value.toFixed(decimals)) === 100 && decimals < 3) ++decimals;
    if (!isAtLimit && Number(value.toFixed(decimals)) === 100) return `${share < 1 ? '<' : '>'}${space}100${space}%`;
    return withUnit(measured(value, decimals, isError(error) ? 100 * error : error, 100), '%');
  }
  // Returns all digits: the program's own text with its error, if given.
  function full(value, unit, text) {
    if (!isKnown(value)) return '';
    return text ? signed(text) : `${signed(String(value))}${unit ? ` ${unit}` : ''}`;
  }
  return { decimalsOf, fixed, one, onScale, column, instant, percent, full, withUnit, roundingOf, roundingIn, isRounding, isKnown };
})();
