// Draws the overlapping sheets of a step-lap joint, strongly magnified across the joint line.
steplap.Inset = (() => {
  const make = steplap.make, { minus, length, unit, apply, relative } = steplap.geometry;
  const width = 246, height = 112;

  const area = (ring) => ring.reduce((sum, p, i) => {
    const q = ring[(i + 1) % ring.length];
    return sum + 0.5 * (p[0] * q[1] - q[0] * p[1]);
  }, 0);
  const counterClockwise = (ring) => (area(ring) < 0 ? [...ring].reverse() : ring);
  const isConvex = (ring) => ring.every((p, i) => {
    const q = ring[(i + 1) % ring.length], r = ring[(i + 2) % ring.length];
    return (q[0] - p[0]) * (r[1] - q[1]) - (q[1] - p[1]) * (r[0] - q[0]) >= -1e-12;
  });
  // Returns the part of a ring inside the convex counter-clockwise polygon `knife` (I. E. Sutherland, G. W. Hodgman, Commun. ACM 17 (1974)
  // 32).
  function clipped(ring, knife) {
    let rest = ring;
    for (let i = 0; i < knife.length && rest.length; ++i) {
      const a = knife[i], b = knife[(i + 1) % knife.length];
      const side = (p) => (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
      const next = [];
      rest.forEach((p, j) => {
        const q = rest[(j + 1) % rest.length], sp = side(p), sq = side(q);
        if (sp >= 0) next.push(p);
        if (sp >= 0 !== sq >= 0) next.push([p[0] + (q[0] - p[0]) * sp / (sp - sq), p[1] + (q[1] - p[1]) * sp / (sp - sq)]);
      });
      rest = next;
    }
    return rest;
  }

  let insets = 0; // ids of clip paths are unique in the page
  const evenodd = { 'fill-rule': 'evenodd', 'clip-rule': 'evenodd' }; // holes stay holes in either orientation

  return class Inset {
    constructor(run, scene, sheet) {
      Object.assign(this, { run, scene, sheet });
      this.yoke = counterClockwise(sheet.yoke);
      this.limb = counterClockwise(sheet.limb_sheet);
      this.yokeHoles = sheet.yoke_holes || []; // missing in results of earlier versions
      this.limbHoles = sheet.limb_holes || [];
      const relativeReference = relative(scene.reference(sheet.active_part), scene.reference(sheet.limb));
      this.frame(relativeReference);
      this.svg = make('svg', { viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': `Sheets of ${sheet.name}` });
      this.parts = {};
      for (const name of ['yoke', 'limb', 'overlap']) this.svg.append((this.parts[name] = make('path', { class: name, ...evenodd })));
      // The overlap is the limb's sheet clipped by the yoke's sheet, with the holes of both.
      const id = `yoke-sheet-${insets++}`;
      this.parts.window = make('path', evenodd);
      this.svg.prepend(make('clipPath', { id }, this.parts.window));
      this.parts.overlap.setAttribute('clip-path', `url(#${id})`);
      this.state = make('strong', { class: 'joint-state' });
      this.figures = make('div', { class: 'joint-figures' });
      this.box =
        make('div', { class: 'inset', 'data-joint': sheet.joint }, make('div', {}, `${sheet.name}: `, this.state), this.svg, this.figures);
      this.margin = run.channel(`${sheet.joint}.margin`);
      this.pressure = run.channel(`${sheet.joint}.p_req`);
    }
    // Sets the drawing's axes along and across the overlap in the reference pose.
    frame(pose) {
      const limb = this.limb.map((p) => apply(pose, p));
      const lap = isConvex(this.yoke) ? clipped(limb, this.yoke) : isConvex(limb) ? clipped(this.yoke, limb) : [];
      const ring = lap.length > 2 ? lap : this.yoke;
      let longest = [1, 0];
      ring.forEach((p, i) => {
        const d = minus(ring[(i + 1) % ring.length], p);
        if (length(d) > length(longest) || i === 0) longest = d;
      });
      this.along = unit(longest);
      this.across = [-this.along[1], this.along[0]];
      const u = ring.map((p) => p[0] * this.along[0] + p[1] * this.along[1]),
            w = ring.map((p) => p[0] * this.across[0] + p[1] * this.across[1]);
      this.middle = [0.5 * (Math.min(...u) + Math.max(...u)), 0.5 * (Math.min(...w) + Math.max(...w))];
      this.scales = [(0.9 * width) / (Math.max(...u) - Math.min(...u)), (0.3 * height) / Math.max(Math.max(...w) - Math.min(...w), 1e-9)];
    }
    path(rings) { return rings.map((ring) => this.loop(ring)).join(''); }
    loop(ring) {
      return 'M' +
        ring
          .map((p) => {
            const u = p[0] * this.along[0] + p[1] * this.along[1] - this.middle[0],
                  w = p[0] * this.across[0] + p[1] * this.across[1] - this.middle[1];
            return `${(width / 2 + u * this.scales[0]).toFixed(2)} ${(height / 2 - w * this.scales[1]).toFixed(2)}`;
          })
          .join('L') +
        'Z';
    }
    show(t) {
      const { scene, sheet } = this;
      const pose = relative(scene.poseAt(sheet.active_part, t), scene.poseAt(sheet.limb, t));
      const yoke = this.path([this.yoke, ...this.yokeHoles]);
      const limb = this.path([this.limb, ...this.limbHoles].map((ring) => ring.map((p) => apply(pose, p))));
      for (const name of ['yoke', 'window']) this.parts[name].setAttribute('d', yoke);
      for (const name of ['limb', 'overlap']) this.parts[name].setAttribute('d', limb);
      const m = this.run.modeAt(sheet.joint, t);
      const states = { 1: ['sticks', 'sticks'], 2: ['slips', 'slips'], 3: ['has come apart', 'slips'] };
      const [text, kind] = states[m] || ['state not recorded', 'free'];
      this.state.textContent = text;
      this.state.className = `joint-state ${kind}`;
      const q = steplap.data.quantity;
      const figures = [];
      if (this.pressure) figures.push(`needs ${q(this.pressure.at(t), 'Pa', 4)}`);
      if (this.margin) figures.push(`margin ${q(this.margin.at(t), '', 4)}`);
      this.figures.textContent = figures.join(', ');
    }
    get caption() { return `across ${steplap.data.plain(this.scales[1] / this.scales[0], 2)} × wider than along`; }
  };
})();
