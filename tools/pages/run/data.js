// Runs of the page, read from its JSON; formats numbers and units as text.
steplap.data = (() => {
  function bytesOf(text) {
    const letters = atob(text), bytes = new Uint8Array(letters.length);
    for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
    return bytes;
  }
  const floats = (text) => new Float32Array(bytesOf(text).buffer);
  const doubles = (text) => new Float64Array(bytesOf(text).buffer);

  // A time history. Values are stored as differences from `zero`, so that single precision resolves 1 mm in a travel of many metres.
  // Numbers are parsed at first use, because the first picture needs few channels.
  class Channel {
    constructor(raw, times) {
      this.name = raw.name;
      this.unit = raw.unit;
      this.zero = raw.zero;
      this.raw = raw;
      this.commonTimes = times;
    }
    get rest() { return this.held || (this.held = floats(this.raw.values)); }
    get times() { return this.ownTimes || (this.ownTimes = this.raw.times ? floats(this.raw.times) : this.commonTimes); }
    get length() { return this.rest.length; }
    // Returns 0 for differences below the rounding error of single precision, about 1e-7 of the first value.
    known(value) { return Math.abs(value) < 2e-7 * Math.abs(this.zero) ? 0 : value; }
    value(i) { return this.known(this.zero + this.rest[i]); }
    // Interpolates linearly between samples; constant outside.
    at(t) { return this.known(this.zero + this.restAt(t)); }
    restAt(t) {
      const n = this.rest.length;
      const i = steplap.data.indexBefore(this.times, t);
      if (i < 0) return this.rest[0];
      if (i >= n - 1) return this.rest[n - 1];
      const t0 = this.times[i], t1 = this.times[i + 1];
      const w = t1 > t0 ? (t - t0) / (t1 - t0) : 0;
      return w === 0 ? this.rest[i] : (1 - w) * this.rest[i] + w * this.rest[i + 1];
    }
  }

  // Returns the largest i with times[i] <= t; -1 if there is none.
  function indexBefore(times, t) {
    let low = 0, high = times.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (times[middle] <= t) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  class Run {
    constructor(raw) {
      Object.assign(this, raw);
      this.times = raw.times ? doubles(raw.times) : new Float64Array([0, 1]);
      this.channels = new Map(raw.channels.map((c) => [c.name, new Channel(c, this.times)]));
    }
    // Returns the mode of a friction element at t: that of the previous sample, updated by events since then.
    modeAt(element, t) {
      const mode = this.channel(`${element}.mode`);
      if (!mode) return NaN;
      const i = Math.max(0, indexBefore(mode.times, t));
      let value = mode.value(i);
      for (const [when, who, , , role] of this.events) {
        if (who !== element || when <= mode.times[i] || when > t) continue;
        if (role === 'stick') value = 1;
        if (role === 'slip') value = 2;
        if (role === 'apart') value = 3;
      }
      return value;
    }
    channel(name) { return this.channels.get(name); }
    // Returns the meaning of a channel with its sign and codes; '' if the results do not state it.
    meaning(name) {
      const entry = this.summary.extremes[name], list = this.summary.meanings;
      return entry && list && list[entry.meaning] ? `${name} [${entry.unit || '–'}]: ${list[entry.meaning]}` : '';
    }
    // Returns the sample time nearest to t.
    nearestTime(t) {
      const i = Math.max(0, indexBefore(this.times, t)), next = Math.min(i + 1, this.times.length - 1);
      return this.times[next] - t < t - this.times[i] ? this.times[next] : this.times[i];
    }
    get end() { return this.times[this.times.length - 1]; }
    // Returns the names that match patterns with * and ?.
    matching(patterns) {
      const found = [];
      for (const pattern of patterns) {
        const text = pattern.replace(/[.+^${}()|[\]\\]/g, '\\$&').replace(/\*/g, '.*').replace(/\?/g, '.');
        const expression = new RegExp('^' + text + '$', 's');
        for (const name of this.channels.keys())
          if (expression.test(name)) found.push(name);
      }
      return found;
    }
  }

  const prefixes = [[1e9, 'G'], [1e6, 'M'], [1e3, 'k'], [1, ''], [1e-3, 'm'], [1e-6, 'µ'], [1e-9, 'n']];
  const prefixable = new Set(['m', 'N', 'N m', 'Pa', 'rad', 'J', 's', 'm/s', 'rad/s', 'W', 'Hz', 'N/m']);
  const pretty = (unit) => unit.replace(/\^2/g, '²').replace(/\^3/g, '³').replace(/ /g, '\u00a0');

  // Returns { factor, unit } for the most readable unit of a quantity of this size. Millimetres and milliradians are used for smaller
  // values than other prefixes, because drawings are dimensioned in them.
  function scaleFor(unit, size) {
    if (unit === 'm^2' && size < 0.01 && size > 0) return { factor: 1e6, unit: 'mm²' };
    if ((unit === 'm' || unit === 'rad') && size < 1 && size >= 2e-6) return { factor: 1e3, unit: 'm' + unit };
    if (!prefixable.has(unit) || !(size > 0) || !isFinite(size)) return { factor: 1, unit: pretty(unit) };
    const [value, prefix] = prefixes.find(([v]) => size >= 0.9995 * v) || prefixes[prefixes.length - 1];
    return { factor: 1 / value, unit: prefix + pretty(unit) };
  }
  function quantity(value, unit, digits = 5) {
    if (value === null || value === undefined || Number.isNaN(value)) return '–';
    if (!isFinite(value)) return value > 0 ? '∞' : '−∞';
    const scale = scaleFor(unit || '', Math.abs(value));
    const number = plain(value * scale.factor, digits);
    return scale.unit ? number + '\u00a0' + scale.unit : number;
  }
  // Formats a number without trailing zeros, with a real minus sign.
  function plain(value, digits = 5) {
    if (value === 0) return '0';
    const size = Math.abs(value);
    let text = size >= 1e6 || size < 1e-4 ? value.toExponential(Math.max(1, digits - 2)) : value.toPrecision(digits);
    if (text.includes('.') && !text.includes('e')) text = text.replace(/\.?0+$/, '');
    if (/^-?\d+e/.test(text) === false && text.includes('e+') && size < 1e6) text = String(Number(text));
    return text.replace('-', '−');
  }

  // Returns one interface per corner of the step-lap joints; a core has many equal ones per corner.
  function corners(run) {
    const cores = run.drawing.cores || [],
          cornerOf = (s) =>
            (cores.some((core) => s.name.startsWith(`${core.name}: `)) ? s.name.replace(/(, packets? .*| \d+)$/, '') : s.name);
    const found = new Map();
    for (const sheet of run.drawing.sheets)
      if (!found.has(cornerOf(sheet))) found.set(cornerOf(sheet), sheet);
    return [...found.values()];
  }

  // Returns all names of several lists, each once, in order of first appearance.
  const unique = (lists) => [...new Set(lists.flat())];

  const raw = JSON.parse(document.getElementById('data').textContent);
  // Returns a run that has only a drawing, in a fixed pose.
  const still = (name, drawing) => new Run({ name, drawing, summary: { extremes: {} }, events: [], channels: [], poseOf: () => null });
  const runs = raw.runs.map((r) => new Run(r));
  return {
    program: raw.program,
    modes: raw.modes,
    loadCases: raw.load_cases,
    still,
    runs,
    Run,
    indexBefore,
    scaleFor,
    quantity,
    plain,
    pretty,
    corners,
    unique
  };
})();

// Creates an element of the page. Strings are added as text, never as markup.
steplap.make = (name, attributes = {}, ...children) => {
  const isSvg = steplap.make.svg.has(name);
  const element = isSvg ? document.createElementNS('http://www.w3.org/2000/svg', name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  for (const c of children)
    element.append(c instanceof Node ? c : String(c)); // appended one by one, since there may be too many for one call
  return element;
};
steplap.make.svg = new Set(['svg', 'g', 'path', 'polygon', 'line', 'circle', 'rect', 'text', 'title', 'tspan', 'clipPath']);
