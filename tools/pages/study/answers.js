// Forms sentences that answer a study. They depend on the roles of its findings, not on the kind of study.
study.answers = (() => {
  const { data } = study, most = 4; // largest number of sentences
  const minus = (text) => text.replace(/-(?=[\d.])/g, '−');
  const withUnit = (text, unit) => (unit ? `${text}\u202f${data.pretty(unit)}` : text);
  const quantity = (f) => (f.text ? withUnit(minus(f.text), f.unit) : '–');
  const interval = (f) => (f.interval ? withUnit(minus(f.interval), f.unit) : '');
  const between = (f) => (f.interval ? ` (${interval(f).replace('…', 'to')})` : '');
  const isKnown = (f) => f.value !== null && isFinite(f.value);
  const doubt = (f) => (f.status ? ` In doubt: ${f.status}.` : '');

  // Formats a probability as a percentage, to two digits of the interval's width; below 0.001 % as a number.
  function chance(f) {
    if (f.value > 0 && f.value < 1e-5) return `${quantity(f)}${between(f)}`;
    const width = f.low !== null && f.high !== null ? 100 * (f.high - f.low) : 0;
    if (!(width > 0)) return `${data.plain(100 * f.value, 3)}\u202f%`;
    const decimals = Math.min(6, Math.max(0, 1 - Math.floor(Math.log10(width)))), text = (v) => (100 * v).toFixed(decimals);
    return `${text(f.value)}\u202f% (${text(f.low)} to ${text(f.high)}\u202f%)`;
  }
  // Sorts results of several methods: without remarks first, then those with an interval, then by its width.
  const rank = (f) => [f.status ? 1 : 0, f.low === null || f.high === null ? 1 : 0, f.high - f.low || 0];
  const byRank = (a, b) => {
    const [p, q] = [rank(a), rank(b)], k = p.findIndex((v, i) => v !== q[i]);
    return k < 0 ? 0 : p[k] - q[k];
  };
  const largest = (list) => [...list].sort((a, b) => Math.abs(b.value) - Math.abs(a.value)).slice(0, 1);
  const best = (list) => [...list].sort(byRank).slice(0, 1);
  const all = (list) => list;

  // [role, function that selects findings, function that forms a sentence]. The first role that occurs in the study determines the answer.
  // If one method gives several probabilities, the plain one is used; the others are corrections to it.
  const sentences = [
    [
      'probability', (list) => best(list.filter((f) => !f.quantity.includes('('))),
      (f) => `The probability of '${f.subject}' is ${chance(f)}.`
    ],
    ['beta', best, (f) => `The reliability index of '${f.subject}' is ${quantity(f)}${between(f)}.`],
    ['critical', all, (f) => `The critical value of '${f.subject}' is ${quantity(f)}${between(f)}.`],
    ['swing', largest, (f) => `'${f.subject}' depends most on '${f.variable}': it goes from ${interval(f)} over its range.`],
    ['elasticity', largest, (f) => `'${f.subject}' depends most on '${f.variable}': it changes by ${quantity(f)} % for one per cent.`],
    ['total', largest, (f) => `'${f.subject}' depends most on '${f.variable}', which makes up ${chance(f)} of its variance.`],
    ['mu*', largest, (f) => `'${f.subject}' depends most on '${f.variable}': it changes by ${quantity(f)}${between(f)} on average.`],
    ['mean', all, (f) => `The mean of '${f.subject}' is ${quantity(f)}${between(f)}.`]
  ];
  function bySubject(list) {
    const groups = new Map();
    for (const f of list) groups.set(f.subject, [...(groups.get(f.subject) || []), f]);
    return [...groups.values()];
  }
  // Returns a sentence with the fitted variables.
  function fitted(found) {
    const values =
      found.filter((f) => f.method === 'fit' && f.role === 'base' && isKnown(f)).map((f) => `${f.subject} ${quantity(f)}${between(f)}`);
    return values.length ? [`The record fits best with ${values.join(', ')}.`] : [];
  }
  function needed(found) {
    const needs = found.filter((f) => f.role === 'need' && isKnown(f)), { accuracy } = data.about.settings;
    if (!needs.length || accuracy === undefined) return [];
    const small = needs.filter((f) => f.value <= accuracy).length;
    return [`${small} of ${needs.length} simplifications change no response by more than ${data.plain(100 * accuracy, 3)}\u202f%.`];
  }
  const extremes = (values) => [Math.min(...values), Math.max(...values)];
  const span = ([low, high]) => `from ${data.plain(low, 4)} to ${data.plain(high, 4)}`;
  function border() {
    const points = data.findings.filter((f) => f.role === 'border' && isKnown(f)), names = [...new Set(points.map((f) => f.variable))];
    if (!points.length) return [];
    const reach = (name) => {
      const { factor = 1, unit = '' } = data.named(name) || {};
      return `'${name}' ${withUnit(span(extremes(points.filter((f) => f.variable === name).map((f) => f.value * factor))), unit)}`;
    };
    return [`The border runs through ${names.map(reach).join(' and ')}.`];
  }
  // Returns sentences with the smallest and largest value of each response.
  function reached(found) {
    return bySubject(found.filter((f) => f.role === 'extreme' && isKnown(f))).filter((ends) => ends.length === 2).map(([low,
      high]) => `'${low.subject}' goes from ${quantity(low)} to ${quantity(high)}.`);
  }
  function list() {
    const found = data.findings.filter((f) => !f.place);
    for (const [role, choose, sentence] of sentences) {
      const own = found.filter((f) => (f.role === role || f.quantity === role) && isKnown(f));
      const told = bySubject(own).flatMap(choose).map((f) => sentence(f) + doubt(f));
      if (told.length) return told.slice(0, most);
    }
    return [fitted, needed, border, reached].map((of) => of(found)).find((told) => told.length)?.slice(0, most) || [];
  }
  return { list, quantity, interval };
})();
