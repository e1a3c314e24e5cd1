// Finds the loads of a run: kind, body, size and time of action, each with a curve and a sentence. The size of a drive is the motion of the
// driven point; that of motors and forces is a channel. Without loads, initial velocities and gravity are reported.
(() => {
  const { add, minus, scaled, dot, length, turn, apply } = steplap.geometry;
  const g = 9.80665; // m/s²
  const acting = 0.02; // smallest size, relative to the largest, at which a load counts as acting
  const whole = 0.02; // a load acts during the whole run if it begins and ends within this fraction of the run from its ends
  const even = 0.1; // largest relative difference between the periods of a vibration
  const least = 1e-9; // smaller loads, in SI units, are rounding errors

  const plain = (v) => steplap.data.plain(v, 3);
  const inUnit = (unit) => (v) => steplap.data.quantity(v, unit, 3);
  const degrees = (v) => `${plain((v * 180) / Math.PI)}°`;
  // Texts of drives by the prescribed quantity and direction: text of the size, and verbs for motion forward, backward and both ways.
  const drives = {
    acceleration: {
      text: (a) => `${plain(a / g)}\u00a0g`,
      along: ['is accelerated with', 'is accelerated backwards with', 'shakes with'],
      up: ['is accelerated upwards with', 'is accelerated downwards with', 'shakes with']
    },
    velocity:
      { text: inUnit('m/s'), along: ['moves at', 'moves backwards at', 'moves to and fro at'], up: ['rises at', 'sinks at', 'heaves at'] },
    position: { text: inUnit('m'), along: ['moves by', 'moves back by', 'moves to and fro by'], up: ['rises by', 'sinks by', 'heaves by'] },
  };
  const turns = {
    acceleration: { text: inUnit('rad/s^2'), along: ['is spun up with', 'is spun up clockwise with', 'shakes with'] },
    velocity: { text: inUnit('rad/s'), along: ['turns at', 'turns clockwise at', 'turns to and fro at'] },
    position: { text: degrees, along: ['turns by', 'turns clockwise by', 'sways by'] },
  };
  const turned = (w, r) => [-w * r[1], w * r[0]]; // w × r

  // --- motion of a driven point relative to its base -----------------------------------------------------
  // Returns position, velocity and acceleration of a point of a body, and the body's angle with its derivatives; null if a channel is
  // missing.
  function motionOf(scene, place) {
    const names = ['x', 'y', 'theta', 'vx', 'vy', 'omega', 'ax', 'ay', 'alpha'];
    if (scene.isHeld(place.body))
      return () => ({ at: apply(scene.reference(place.body), place.point), v: [0, 0], a: [0, 0], angle: [0, 0, 0] });
    const channels = names.map((name) => scene.run.channel(`${place.body}.${name}`));
    if (!channels.every(Boolean)) return null;
    return (t) => {
      const [x, y, angle, vx, vy, w, ax, ay, alpha] = channels.map((c) => c.at(t)), r = turn(place.point, angle);
      const a = minus(add([ax, ay], turned(alpha, r)), scaled(r, w * w));
      return { at: add([x, y], r), v: add([vx, vy], turned(w, r)), a, angle: [angle, w, alpha] };
    };
  }
  // Returns relative velocity and acceleration of the driven point in the rotating axes of the base.
  function relativeTo(base, point) {
    const [, w, alpha] = base.angle, r = minus(point.at, base.at), v = minus(minus(point.v, base.v), turned(w, r));
    const frame = add(turned(alpha, r), scaled(r, -w * w)), a = minus(minus(minus(point.a, base.a), frame), scaled(turned(w, v), 2));
    return [r, v, a];
  }
  const rates = ['position', 'velocity', 'acceleration'];
  // Returns 0 for differences that are rounding errors, because channels have single precision.
  const known = (value, ...of) => (Math.abs(value) < 1e-6 * Math.max(...of.map(Math.abs)) ? 0 : value);
  // Returns the prescribed motion of a drive as a function of time; null if the results lack it.
  function driveOf(scene, element, shape) {
    const [driven, base] = shape.at, ends = base ? [motionOf(scene, driven), motionOf(scene, base)] : [null],
                   rate = rates.indexOf(element.as);
    if (!ends.every(Boolean) || (shape.type === 'spring' && rate === 2)) return null;
    const at = {
      arc: ([a, b]) => known(a.angle[rate] - b.angle[rate], a.angle[rate], b.angle[rate]),
      arrow: ([a, b]) => {
        const d = turn(shape.direction, b.angle[0]), own = [a.at, a.v, a.a][rate];
        return known(dot(d, relativeTo(b, a)[rate]), length(own));
      },
      spring: ([a, b]) => {
        const [r, v] = relativeTo(b, a);
        return rate === 0 ? length(r) : dot(r, v) / length(r);
      }
    }[shape.type];
    const value = (t) => at(ends.map((end) => end(t))), start = rate === 0 ? value(0) : 0, size = length(ends[0](0).at);
    const reaction = scene.run.channel(`${element.name}.reaction`),
          isReleased = (t) => Boolean(reaction) && reaction.at(t) === 0; // released by an action
    const isUp = shape.type === 'arrow' && Math.abs(dot(shape.direction, scene.run.drawing.gravity || [0, -g])) > 0.7 * g,
          { text, along, up } = (shape.type === 'arc' ? turns : drives)[element.as];
    return { at: (t) => (isReleased(t) ? 0 : known(value(t) - start, rate === 0 ? size : 0)), text, verbs: isUp ? up : along };
  }

  // --- forces and couples --------------------------------------------------------------------------------------
  function forceOf(scene, element, shape) {
    const [x, y] = ['x', 'y'].map((axis) => scene.run.channel(`${element.name}.force_${axis}`));
    if (shape.style === 'load' && (!x || !y)) return null;
    const channel = scene.run.channel(`${element.name}.${shape.quantity}`), along = (t) => [x.at(t), y.at(t)];
    if (!channel) return null;
    const text = inUnit(channel.unit), does = shape.type === 'arc' ? 'turns' : 'pushes';
    return shape.style === 'load' ? { at: (t) => length(along(t)), along, text, does: 'acts on' }
                                  : { at: (t) => channel.at(t), text, does };
  }

  // styles of shapes that are loads; others are loads only if the element has the field `as`
  const driving = { arrow: ['motor', 'load'], arc: ['motor', 'couple'], spring: [] };
  const isDriving = (element, { type, style }) => type in driving && (Boolean(element.as) || driving[type].includes(style));

  // --- times of action --------------------------------------------------------------------------------------------
  // Returns all recorded times; thinned channels have fewer.
  function instantsOf(run) {
    const longest = (a, c) => (c.times.length > a.length ? c.times : a);
    return Array.from(run.times.length > 2 ? run.times : [...run.channels.values()].reduce(longest, run.times));
  }
  // Returns the frequency, Hz, of a curve that crosses its mean at regular intervals for at least two periods; otherwise 0.
  function frequencyOf(times, values) {
    const high = values.reduce((a, b) => Math.max(a, b)), low = values.reduce((a, b) => Math.min(a, b)), middle = 0.5 * (high + low);
    const ups = times.filter((_, i) => i > 0 && values[i - 1] < middle && values[i] >= middle);
    const periods = ups.slice(1).map((t, i) => t - ups[i]), mean = periods.reduce((a, b) => a + b, 0) / (periods.length || 1);
    return periods.length > 1 && periods.every((p) => Math.abs(p - mean) < even * mean) ? 1 / mean : 0;
  }
  // Adds size and times of action to a load; returns null if it never acts.
  function measured(scene, load) {
    const times = instantsOf(scene.run), values = times.map(load.at), sizes = values.map(Math.abs),
          peak = sizes.reduce((a, b) => Math.max(a, b), 0);
    if (!(peak > least)) return null;
    const end = times[times.length - 1], at = sizes.indexOf(peak), when = times.filter((_, i) => sizes[i] > acting * peak);
    const [from, to] = [when[0], when[when.length - 1]], isWhole = from <= whole * end && to >= (1 - whole) * end;
    const isSteady = isWhole && sizes.every((v) => v > 0.98 * peak), reaches = (sign) => values.some((v) => sign * v > 0.3 * peak);
    return {
      ...load,
      times,
      values,
      peak,
      from,
      to,
      isWhole,
      isSteady,
      isBothWays: reaches(1) && reaches(-1),
      frequency: frequencyOf(times, values),
      peakAt: times[at],
      isBackward: values[at] < 0
    };
  }
  function whenOf({ from, to, isWhole, frequency }, end) {
    const text = (t) => steplap.numbers.instant(t, end),
          rhythm = frequency >= 0.2 ? ` at ${plain(frequency)}\u00a0Hz`
      : frequency ? ` every ${plain(1 / frequency)}\u00a0s`
                  : '';
    return rhythm + (isWhole ? '' : ` from ${text(from)} to ${text(to)}`);
  }
  // Returns the verb for a load. A drive against the motion brakes.
  function verbOf(scene, { element, shape, verbs, from, isBackward, isBothWays }) {
    const vx = scene.run.channel(`${shape.at[0].body}.vx`), before = vx && shape.direction ? vx.at(from) * shape.direction[0] : 0;
    if (!isBothWays && element.as === 'acceleration' && shape.type === 'arrow' && before * (isBackward ? -1 : 1) < 0)
      return 'is braked with';
    return verbs[isBothWays ? 2 : isBackward ? 1 : 0];
  }
  const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);
  function sentenceOf(scene, load) {
    const { element, shape, isSteady, isBothWays, frequency } = load, body = shape.at[0].body,
                                                            isVague = element.as ? isBothWays && !frequency : !isSteady;
    const size = `${isVague ? 'up to ' : ''}${load.text(load.peak)}${whenOf(load, scene.run.end)}`;
    const words =
      element.as ? `${element.signal || element.name}: ${body} ${verbOf(scene, load)}` : `${element.name} ${load.does} ${body} with`;
    return capital(`${words} ${size}.`);
  }

  // --- without loads: initial velocities and gravity ---------------------------------------------------------------
  const startOf = (scene, body) => ['vx', 'vy', 'omega'].map((name) => {
    const c = scene.run.channel(`${body.name}.${name}`);
    return c ? c.at(0) : 0;
  });
  // Returns groups of bodies with the same initial velocity, or rotation about the same point: [{ names, velocity, spin }].
  function startsOf(scene) {
    const groups = [];
    for (const body of [...scene.bodies.values()].filter((b) => b.channels)) {
      const [vx, vy, spin] = startOf(scene, body), velocity = [vx, vy], isSpun = Math.abs(spin) * body.reach > length(velocity);
      const own = isSpun ? { spin } : { velocity };
      const same = groups.find(
        (group) => (isSpun ? group.spin === spin : group.velocity && length(minus(group.velocity, velocity)) < 1e-9 * length(velocity)));
      if (same) same.names.push(body.name);
      else if (length(velocity) > 1e-6 || isSpun) groups.push({ names: [body.name], ...own });
    }
    return groups.filter((group) => !group.spin || Math.abs(group.spin) > 1e-6);
  }
  function startLoads(scene) {
    return startsOf(scene).map(({ names, velocity, spin }) => {
      const body = names.map((n) => scene.body(n)).reduce((a, b) => (b.reach > a.reach ? b : a)), { name } = body,
            others = names.length - 1;
      const speed = velocity ? length(velocity) : Math.abs(spin), text = inUnit(velocity ? 'm/s' : 'rad/s');
      const channels = ['vx', 'vy', 'omega'].map((c) => scene.run.channel(`${name}.${c}`)),
            along = velocity ? scaled(velocity, 1 / speed) : null;
      const at = (t) => (along ? dot(along, channels.slice(0, 2).map((c) => c.at(t))) : channels[2].at(t));
      const shape = {
        type: along ? 'arrow' : 'arc',
        at: [{ body: name, point: [0, 0] }, { body: 'ground', point: [0, 0] }],
        direction: along
      };
      const who = others ? `${name} and ${others} more` : name, verb = along ? (others ? 'move' : 'moves') : others ? 'turn' : 'turns';
      const sentence = capital(`${who} ${verb} at ${text(speed)} at the start.`);
      return {...measured(scene, { element: { name, as: 'velocity' }, shape, at, text }), sentence };
    });
  }
  function gravityLoad(scene) {
    const { gravity } = scene.run.drawing;
    if (!gravity || !(length(gravity) > 0)) return [];
    const leaning = Math.atan2(gravity[0], -gravity[1]), text = (v) => `${plain(v / g)}\u00a0g`, name = 'gravity';
    const way = Math.abs(leaning) < 1e-3 ? '' : `, leaning by ${degrees(Math.abs(leaning))}`;
    const load = { element: { name }, at: () => length(gravity), along: () => gravity, text, isField: true };
    return [{...measured(scene, load), sentence: `Gravity acts${way}, and no other load.` }];
  }

  Object.assign(steplap.Scene.prototype, {
    // Returns the loads of this run in the order of the model, as [{ element, shape, at(t), peak, from, to, times, values, text(size),
    // sentence }].
    causes() {
      if (this.foundCauses) return this.foundCauses;
      const found = this.elements.flatMap((element) => element.shapes.map((shape) => this.loadOf(element, shape)).filter(Boolean));
      this.foundCauses = found.length ? found
        : this.run.poseOf             ? []
                                      : [startLoads, gravityLoad].map((make) => make(this)).find((loads) => loads.length) || [];
      return this.foundCauses;
    },
    // Returns the load shown by a shape of an element; null if it never acts, undefined if its size is not in the results.
    loadOf(element, shape) {
      if (!this.foundLoads) this.foundLoads = new Map();
      if (!this.foundLoads.has(shape))
        this.foundLoads.set(shape, this.run.poseOf || !isDriving(element, shape) ? undefined : this.measuredLoad(element, shape));
      return this.foundLoads.get(shape);
    },
    measuredLoad(element, shape) {
      const load = element.as ? driveOf(this, element, shape) : forceOf(this, element, shape),
            size = load && measured(this, {...load, element, shape });
      return size ? {...size, sentence: sentenceOf(this, size) } : load ? null : undefined;
    },
  });
})();
