// Events on a time axis with the slider: one lane for each element that slips, opens or breaks, with its intervals and signs at their
// begins and ends. Overlapping signs are merged into one with a count.
steplap.Timeline = (() => {
  const make = steplap.make;
  const size = 14, laneHeight = 20, thumb = 16, causeHeight = 22; // sizes in pixels
  const mostCauses = 3; // largest number of loads with a curve

  // Pairs of events that begin and end an interval.
  const stretches = [
    { begins: ['slip'], ends: ['stick', 'free', 'apart'], class: 'slipping', word: 'slips' },
    { begins: ['open'], ends: ['close', 'strike'], class: 'open', word: 'is open' }
  ];

  // Returns the elements whose events have a sign: those that slipped or broke first, then the others of the story.
  function lanesOf(run, most) {
    const { moved, story } = steplap.overview.of(run), lanes = new Map();
    for (const [t, who, what, text, role] of run.events) {
      if (!steplap.signs.has(role)) continue;
      if (!lanes.has(who)) lanes.set(who, { who, events: [] });
      lanes.get(who).events.push({ t, role, text: `${who} ${what} at ${text}`, who });
    }
    const told = story.flatMap((s) => s.who || []);
    const isGrave = (lane) => lane.events.some((e) => ['slip', 'apart', 'break'].includes(e.role));
    const rank = (lane) => (isGrave(lane) ? 0 : moved.includes(lane.who) ? 1 : told.includes(lane.who) ? 2 : 3);
    const sorted = [...lanes.values()].sort((a, b) => rank(a) - rank(b) || a.events[0].t - b.events[0].t);
    if (sorted.length <= most) return sorted;
    const rest = sorted.slice(most - 1);
    const others = { who: `${rest.length} others`, isMany: true, events: rest.flatMap((lane) => lane.events).sort((a, b) => a.t - b.t) };
    return [...sorted.slice(0, most - 1), others];
  }
  // Returns the intervals of one element as [{ from, to, kind }].
  function stretchesOf(lane, end) {
    if (lane.isMany) return [];
    const found = [];
    for (const kind of stretches) {
      const own = lane.events.filter((e) => kind.begins.includes(e.role) || kind.ends.includes(e.role));
      let from = own.length && kind.ends.includes(own[0].role) && own[0].t > 0 ? 0 : null;
      for (const e of own) {
        if (kind.begins.includes(e.role)) from = from === null ? e.t : from;
        else if (from !== null) {
          found.push({ from, to: e.t, kind });
          from = null;
        }
      }
      if (from !== null) found.push({ from, to: end, kind });
    }
    return found;
  }
  // Groups events whose signs would overlap: [{ x, events }].
  function gathered(events, xOf) {
    const groups = [];
    for (const e of events) {
      const x = xOf(e.t), last = groups[groups.length - 1];
      if (last && x - last.x < (last.events.length > 1 ? size + 20 : size + 3)) last.events.push(e);
      else groups.push({ x, events: [e] });
    }
    // A sign with a count is wider, so it may overlap the next group.
    for (let i = 1; i < groups.length; ++i)
      if (groups[i - 1].events.length > 1 && groups[i].x - groups[i - 1].x < size + 20) {
        groups[i - 1].events.push(...groups[i].events);
        groups.splice(i--, 1);
      }
    return groups;
  }

  return class Timeline {
    // `end`: end of the time axis, which may be before that of the runs. `causes`: loads of each run (causes.js).
    constructor(runs, end, { causes, lanes, axis, slider, onTime }) {
      Object.assign(this, { runs, end, causes, box: lanes, axisBox: axis, slider, onTime });
      this.most = runs.length > 1 ? 3 : 5;
      this.lanes = runs.map((run) => ({ run, lanes: lanesOf(run, this.most) }));
      this.box.addEventListener('pointerdown', (event) => {
        if (event.target.closest('[data-t]')) return;
        const x = event.clientX - this.box.getBoundingClientRect().left;
        if (x >= this.left) this.onTime(Math.min(this.end, Math.max(0, this.timeAt(x))));
      });
    }
    xOf(t) { return this.left + ((this.width - this.left - this.right) * t) / this.end; }
    timeAt(x) { return ((x - this.left) * this.end) / (this.width - this.left - this.right); }
    // Reserves space for names in front of the lanes; on a narrow screen they are above the lanes.
    measure(width) {
      this.width = Math.max(240, width || this.box.clientWidth || 1260);
      this.isNarrow = this.width < 560;
      const canvas = document.createElement('canvas').getContext('2d');
      canvas.font = '12px "DejaVu Sans", Arial, sans-serif';
      const names = this.lanes.flatMap(({ lanes }) => lanes.map((lane) => canvas.measureText(lane.who).width));
      this.left = this.isNarrow ? thumb / 2 + 2 : Math.min(0.3 * this.width, Math.max(60, ...names) + 14);
      this.right = thumb / 2 + 2;
      this.canvas = canvas;
    }
    shortened(name) {
      const room = this.isNarrow ? this.width - 20 : this.left - 14;
      if (this.canvas.measureText(name).width <= room) return name;
      let text = name;
      while (text.length > 3 && this.canvas.measureText(`${text}…`).width > room) text = text.slice(0, -1);
      return `${text}…`;
    }
    // Builds the drawing with this width in pixels, by default that of its container.
    build(width) {
      this.measure(width);
      this.box.replaceChildren();
      const all = this.lanes.filter(({ lanes }) => lanes.length);
      this.lanes.forEach(({ run, lanes }, k) => {
        if (this.runs.length > 1) this.box.append(make('h4', {}, run.name));
        this.box.append(...this.drawCauses(this.causes[k]));
        if (lanes.length) this.box.append(this.drawLanes(run, lanes));
        else if (this.runs.length > 1 || !all.length) this.box.append(make('p', { class: 'note' }, 'Nothing slipped, opened or broke.'));
      });
      this.cursor = make('div', { class: 'time-cursor', 'aria-hidden': 'true' });
      this.box.append(this.cursor);
      this.drawAxis();
      // Aligns the middle of the slider's thumb with the axis.
      this.slider.style.marginLeft = `${this.left - thumb / 2}px`;
      this.slider.style.width = `${this.width - this.left - this.right + thumb}px`;
    }
    // Draws each load as a sentence and a curve.
    drawCauses(causes) {
      const most = this.runs.length > 1 ? 1 : mostCauses, rest = causes.length - most;
      const shown = causes.slice(0, most).map(
        (cause) => make('div', { class: 'cause', style: `--left:${this.left}px` }, make('p', {}, cause.sentence), this.causeCurve(cause)));
      if (rest > 0)
        shown.push(make('details', { class: 'cause more' }, make('summary', {}, `${rest} more load${rest > 1 ? 's' : ''}`),
          make('p', {}, causes.slice(most).map((c) => c.sentence).join(' '))));
      return shown;
    }
    // Draws the curve of a load about zero, scaled to its own peak.
    causeCurve({ times, values, peak, sentence }) {
      const svg = make('svg',
        { viewBox: `0 0 ${this.width} ${causeHeight}`, width: this.width, height: causeHeight, role: 'img', 'aria-label': sentence });
      const reaches = (sign) => (values.some((v) => sign * v > 0.02 * peak) ? 1 : 0), [up, down] = [reaches(1), reaches(-1)];
      const y = (v) => 1 + ((causeHeight - 2) * (up * peak - v)) / ((up + down) * peak || 1),
            points = this.thinned(times, values).map(([t, v]) => `${this.xOf(t).toFixed(1)} ${y(v).toFixed(1)}`);
      const first = this.xOf(Math.min(times[0], this.end)), last = this.xOf(Math.min(times[times.length - 1], this.end));
      svg.append(
        make('path',
          { class: 'cause-area', d: `M${first.toFixed(1)} ${y(0).toFixed(1)}L${points.join('L')}L${last.toFixed(1)} ${y(0).toFixed(1)}Z` }),
        make('line', { class: 'lane', x1: this.left, x2: this.width - this.right, y1: y(0), y2: y(0) }),
        make('path', { class: 'cause-curve', d: `M${points.join('L')}` }));
      return svg;
    }
    // Returns the smallest and largest value per pixel, up to the end of the axis.
    thinned(times, values) {
      const found = new Map();
      times.forEach((t, i) => {
        if (t > this.end) return;
        const x = Math.round(this.xOf(t)), pair = found.get(x) || [[t, values[i]], [t, values[i]]];
        if (values[i] < pair[0][1]) pair[0] = [t, values[i]];
        if (values[i] > pair[1][1]) pair[1] = [t, values[i]];
        found.set(x, pair);
      });
      return [...found.values()].flatMap((pair) => (pair[0][0] <= pair[1][0] ? pair : [pair[1], pair[0]]));
    }
    drawLanes(run, lanes) {
      const step = this.isNarrow ? laneHeight + 14 : laneHeight, height = lanes.length * step + 2;
      const svg = make('svg', {
        viewBox: `0 0 ${this.width} ${height}`,
        width: this.width,
        height,
        class: 'lanes',
        role: 'list',
        'aria-label': `Events of ${run.name}`
      });
      lanes.forEach((lane, k) => {
        const y = k * step + (this.isNarrow ? 14 : 0) + laneHeight / 2 + 1;
        svg.append(
          make('text', this.isNarrow ? { x: 2, y: y - 12, class: 'lane-name' } : { x: this.left - 12, y: y + 4, class: 'lane-name end' },
            make('title', {}, lane.who), this.shortened(lane.who)));
        svg.append(make('line', { x1: this.left, x2: this.width - this.right, y1: y, y2: y, class: 'lane' }));
        for (const { from, to, kind } of stretchesOf(lane, Math.min(run.end, this.end)))
          svg.append(make('rect',
            { x: this.xOf(from), width: Math.max(1.5, this.xOf(to) - this.xOf(from)), y: y - 4, height: 8, class: `stretch ${kind.class}` },
            make('title', {}, `${lane.who} ${kind.word}`)));
        for (const group of gathered(lane.events, (t) => this.xOf(t))) svg.append(this.sign(group, y));
      });
      return svg;
    }
    sign(group, y) {
      const [firstEvent] = group.events, count = group.events.length, role = steplap.signs.worst(group.events.map((e) => e.role));
      const text = count === 1 ? firstEvent.text
                               : `${count} events from ${firstEvent.text.replace(/^.* at /, '')}:\n${
                                   group.events.slice(0, 12).map((e) => e.text).join('\n')}${count > 12 ? '\n…' : ''}`;
      const box = make('g', { class: 'event', role: 'listitem', 'data-t': firstEvent.t, 'data-who': firstEvent.who, 'data-count': count },
        make('title', {}, text));
      const x = Math.min(group.x, this.width - this.right - (count > 1 ? 18 : 0)); // keeps the count within the picture
      box.append(steplap.signs.mark(role, x, y, size));
      if (count > 1) box.append(make('text', { x: x + size / 2 + 2, y: y + 4, class: 'count' }, count > 99 ? '99+' : `×${count}`));
      box.addEventListener('click', () => this.onTime(firstEvent.t));
      return box;
    }
    drawAxis() {
      const isShort = this.end < 0.01, k = isShort ? 1000 : 1, height = 22;
      const svg = make('svg', { viewBox: `0 0 ${this.width} ${height}`, width: this.width, height, class: 'axis', 'aria-hidden': 'true' });
      const ticks = steplap.axes.ticks(0, k * this.end, Math.max(3, Math.floor((this.width - this.left) / 80)));
      ticks.values.forEach((v, i) => {
        const x = this.xOf(v / k), isLast = i === ticks.values.length - 1, isFirst = x < 20;
        svg.append(make('line', { x1: x, x2: x, y1: 0, y2: 5, class: 'tick' }));
        const anchor = x > this.width - 30 ? 'end' : isFirst ? 'start' : 'middle';
        svg.append(make('text', { x: anchor === 'end' ? this.width - 2 : x, y: 17, class: 'tick-text', 'text-anchor': anchor },
          steplap.axes.label(v, ticks.step) + (isLast ? ` ${isShort ? 'ms' : 's'}` : '')));
      });
      const worst = steplap.overview.worstOf(this.runs);
      if (worst !== null) {
        const x = this.xOf(worst);
        svg.append(make('path', { d: `M${x} 0l-5 8h10z`, class: 'worst' }, make('title', {}, 'nearest to a limit')));
      }
      this.axisBox.replaceChildren(svg);
    }
    show(t) {
      this.cursor.style.left = `${this.xOf(Math.min(t, this.end))}px`;
      this.slider.value = String(t);
      this.slider.setAttribute('aria-valuetext', steplap.numbers.instant(t, this.end));
    }
    // Returns the time of the previous or next event; begin or end of the axis if there is none.
    beside(t, direction) {
      const times = this.runs.flatMap((run) => run.events.filter((e) => steplap.signs.has(e[4])).map((e) => e[0])).sort((a, b) => a - b);
      const room = 1e-9 * this.end;
      if (direction > 0) return times.find((v) => v > t + room) ?? this.end;
      return times.reverse().find((v) => v < t - room) ?? 0;
    }
  };
})();

// Lists the events as sentences, one per line; a click shows the instant.
steplap.story = (() => {
  const make = steplap.make, first = 6;
  function line(entry, onTime) {
    const button = make('button', { type: 'button', class: 'story-entry', 'data-from': String(entry.from) },
      steplap.signs.icon(steplap.signs.ofWord(entry.what)), make('span', {}, entry.text));
    button.addEventListener('click', () => onTime(entry.from));
    return make('li', {}, button);
  }
  function build(box, runs, onTime) {
    const told = runs.filter((run) => !steplap.overview.of(run).isOld);
    box.hidden = !told.length;
    if (!told.length) return;
    box.append(make('h2', {}, 'What happened'));
    const parts = make('div', { class: 'parts' });
    box.append(parts);
    for (const run of told) {
      const { story } = steplap.overview.of(run),
                    list = (some) => make('ul', { class: 'story' }, ...some.map((entry) => line(entry, onTime)));
      const part = make('div', {}, ...(runs.length > 1 ? [make('h4', {}, run.name)] : []));
      if (!story.length) part.append(make('p', {}, 'Nothing slipped, lifted, opened or broke.'));
      else part.append(list(story.slice(0, first)));
      if (story.length > first)
        part.append(make('details', {}, make('summary', {}, `${story.length - first} more`), list(story.slice(first))));
      parts.append(part);
    }
  }
  return { build };
})();
