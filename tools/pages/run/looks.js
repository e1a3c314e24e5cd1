// Draws parts of bodies given by [[look]] in the model: wheels, windings, wooden blocks, feet, tanks with oil, roads and rails.
(() => {
  const make = steplap.make;
  const turns = 9; // number of lines in a winding
  const strip = 22; // depth of a road below its surface, pixels
  const apart = 38; // distance between the dashes of a road or the sleepers of a track, pixels
  let clips = 0; // ids of clip paths are unique in the page

  const rect = ([x, y], [w, h], style) => make('path', { class: style, d: `M${x - 0.5 * w} ${y - 0.5 * h}h${w}v${h}h${- w}Z` });
  const ring = (points) => 'M' + points.map((p) => p.join(' ')).join('L') + 'Z';
  const disc = ([cx, cy], r, style) => make('circle', { cx, cy, r, class: style });

  // Returns half the width and height of a part; null if the part has the size of its body.
  const halfOf = (look) => (look.radius ? [look.radius, look.radius] : look.size ? look.size.map((v) => 0.5 * v) : null);
  // Returns the corners of the boxes around the parts of a body.
  steplap.partsOf = (run, name) => (run.drawing.looks || []).filter((look) => look.body === name).flatMap((look) => {
    const half = halfOf(look);
    return half ? look.at.flatMap(([x, y]) => [[x - half[0], y - half[1]], [x + half[0], y + half[1]]]) : [];
  });

  const drawn = {
    wheel: (look, at) => [disc(at, look.radius, 'tyre'), disc(at, 0.6 * look.radius, 'rim'), disc(at, 0.2 * look.radius, 'hub')],
    winding: ({ size: [w, h] }, [x, y]) => {
      const lines = Array.from({ length: turns }, (_, k) => `M${x - 0.5 * w} ${y - 0.5 * h + ((k + 1) * h) / (turns + 1)}h${w}`).join('');
      return [rect([x, y], [w, h], 'winding'), make('path', { class: 'winding turns', d: lines })];
    },
    wood: ({ size: [w, h] }, [x, y]) => {
      const line = (from, rise) => `M${x - 0.5 * w} ${y + from * h}l${w} ${rise * h}`;
      return [rect([x, y], [w, h], 'wood'), make('path', { class: 'wood grain', d: line(-0.2, 0.3) + line(0.2, 0.2) })];
    },
    foot: (look, at) => [rect(at, look.size, 'foot')],
  };
  // Returns the shapes of a tank. The wall is the inner half of a line along the outline; oil fills the part below its level.
  function tank(look, body) {
    const id = `tank-${clips++}`, low = Math.min(...body.outline.map((p) => p[1])), reach = 2 * body.reach;
    const inside = { 'clip-path': `url(#${id})` }, parts = [make('clipPath', { id }, make('path', { d: ring(body.outline) }))];
    const oil = `M${- reach} ${low}H${reach}V${look.oil}H${- reach}Z`;
    if (look.oil !== undefined) parts.push(make('path', {...inside, class: 'oil', d: oil }));
    return [...parts, make('path', {...inside, class: 'wall', d: ring(body.outline), 'stroke-width': 2 * look.wall })];
  }

  Object.assign(steplap.Scene.prototype, {
    looksOf(name) { return (this.run.drawing.looks || []).filter((look) => look.body === name); },
    // Returns the shapes of a body's parts in its axes.
    looksShapes(body) {
      const partsOf = (look) => (drawn[look.draw] ? look.at.flatMap((at) => drawn[look.draw](look, at)) : []);
      return this.looksOf(body.name).flatMap((look) => (look.draw === 'tank' ? tank(look, body) : partsOf(look)));
    },
    wallOf(body) { return Math.max(0, ...this.looksOf(body.name).map((look) => look.wall || 0)); },
    isOnLook(body, p) {
      return this.looksOf(body.name).some((look) => {
        const half = halfOf(look);
        return half && look.at.some((at) => [0, 1].every((i) => Math.abs(p[i] - at[i]) <= half[i]));
      });
    },
    isTank(name) { return this.looksOf(name).some((look) => look.draw === 'tank'); },
    // Returns the centres of a body's wheels, in its axes.
    wheelsOf(name) { return this.looksOf(name).filter((look) => look.draw === 'wheel').flatMap((look) => look.at); },
    // Builds the roads and rails of the ground: level strips as wide as the picture.
    buildRoads() {
      for (const look of this.looksOf('ground').filter(({ draw }) => draw === 'road' || draw === 'rail')) {
        const band = make('path', { class: look.draw }), line = make('path', { class: `${look.draw} line` });
        this.groundLayer.append(band, line);
        this.updaters.push((t, pose) => {
          const [, y] = this.screenOf('ground', look.at[0], pose), passed = this.scale * this.passedAt(t);
          band.setAttribute('d', `M0 ${y}H${this.width}V${y + (look.draw === 'road' ? strip : 5)}H0Z`);
          const mark = (x) => (look.draw === 'road' ? `M${x} ${y + 0.5 * strip}h22` : `M${x} ${y + 5}h14v5h-14Z`);
          let text = '';
          for (let x = -(((passed % apart) + apart) % apart); x < this.width; x += apart) text += mark(x);
          line.setAttribute('d', text);
        });
      }
    },
    screenOf(name, point, pose) { return this.toScreen(this.placed({ body: name, point }, pose)); },
    // Returns the distance by which the marks of the road have moved past the followed vehicle at time t.
    passedAt(t) {
      const journey = this.seenFrom === 'ground' ? null : this.journey();
      return journey ? journey.travel(t)[0] : 0;
    },
  });
})();
