// Reads the study from the page's JSON; formats numbers; creates elements.
study.make = (name, attributes = {}, ...children) => {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children.map((c) => (c instanceof Node ? c : String(c))));
  return element;
};

study.data = (() => {
  const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const raw = JSON.parse(document.getElementById('data').textContent);
  const pretty = (unit) => unit.replace(/\^2/g, '²').replace(/\^3/g, '³').replace(/ /g, '\u202f');

  // Formats a number without trailing zeros, with a real minus sign.
  function plain(value, digits = 6) {
    if (value === null || value === undefined || Number.isNaN(value)) return '–';
    if (!isFinite(value)) return value > 0 ? '∞' : '−∞';
    if (value === 0) return '0';
    const size = Math.abs(value);
    let text = size >= 1e7 || size < 1e-3 ? value.toExponential(digits - 1) : value.toPrecision(digits);
    if (text.includes('e')) text = String(Number(text).toExponential()).replace('e+', 'e');
    else if (text.includes('.')) text = text.replace(/\.?0+$/, '');
    return text.replace(/-/g, '−');
  }
  const withUnit = (name, unit) => (unit ? `${name} [${pretty(unit)}]` : name);

  // Values of a variable, response or limit state for all samples on the page, in the unit with its prefix.
  class Column {
    constructor(entry) {
      Object.assign(this, entry);
      this.values = new Float64Array(bytesOf(entry.data).buffer);
      if (this.factor !== 1)
        for (let i = 0; i < this.values.length; ++i) this.values[i] *= this.factor;
      this.head = withUnit(this.name, this.unit);
      delete this.data;
    }
    text(i) {
      const value = this.values[i];
      if (this.name === 'variant' && raw.about.variants.length)
        return value === 0 ? 'as it is' : raw.about.variants[value - 1] || plain(value);
      return plain(value);
    }
    get varies() { return this.values.some((v) => v !== this.values[0] && !(Number.isNaN(v) && Number.isNaN(this.values[0]))); }
  }

  const columns = raw.samples.columns.map((c) => new Column(c));
  const numbers = new Uint32Array(bytesOf(raw.samples.numbers).buffer), status = bytesOf(raw.samples.status);
  const reason = new Uint32Array(bytesOf(raw.samples.reason).buffer);
  const limits = columns.filter((c) => c.role === 'limit state');
  const named = (name) => columns.find((c) => c.name === name);
  // Returns the outcome of sample i: 2 for a failed run, 1 if a limit state is negative, otherwise 0.
  const fate = (i, of = limits) => (status[i] ? 2 : of.some((c) => c.values[i] < 0) ? 1 : 0);
  const classes = raw.samples.classes, shown = numbers.length;
  function shownText() {
    if (shown === raw.samples.total) return `All ${raw.samples.total} samples are on this page.`;
    const part = (k, noun) => (classes[k].all ? [`${classes[k].shown} of ${classes[k].all} ${noun}`] : []);
    return `This page holds ${shown} of ${raw.samples.total} samples, evenly taken: ${
               [...part(2, 'runs that failed'), ...part(1, 'failures'), ...part(0, 'others')].join(', ')}. ` +
      'Distributions and estimates are of all of them; steplap study export writes all.';
  }
  return {
    ...raw,
    columns,
    numbers,
    status,
    limits,
    named,
    fate,
    shown,
    shownText,
    plain,
    pretty,
    withUnit,
    reasonOf: (i) => raw.samples.reasons[reason[i]],
    statusOf: (i) => raw.statuses[status[i]],
    variables: columns.filter((c) => c.role === 'variable'),
    outputs: columns.filter((c) => c.role !== 'variable' && c.role !== 'cost')
  };
})();

// Creates a table. A cell is a text, a node, or { text, class }. `numeric`: indices of columns with numbers.
study.table = (heads, rows, numeric = []) => {
  const { make } = study;
  const cell = (name, content, i) => {
    const isPart = content && content.text !== undefined && !(content instanceof Node);
    const classes = [numeric.includes(i) ? 'number' : '', isPart && content.class ? content.class : ''].join(' ').trim();
    return make(name, classes ? { class: classes } : {}, isPart ? content.text : content === undefined || content === null ? '' : content);
  };
  const element = make('table');
  if (heads)
    element.append(make('thead', {}, make('tr', {}, ...heads.map((h, i) => {
      const th = cell('th', h, i);
      th.scope = 'col';
      return th;
    }))));
  element.append(
    make('tbody', {}, ...rows.map((row) => make('tr', row.class ? { class: row.class } : {}, ...row.map((c, i) => cell('td', c, i))))));
  return element;
};
