// Chooses the reference body of a picture and the magnification of motion.
//
// Usually the ground is the reference. A vehicle that drives away is followed: its travel is subtracted ("alongside"). The motion of each
// body is magnified relative to the body that carries it, so that a slide in a tank is not hidden by the tank's motion, and a vehicle that
// pitches on its springs stays on its road. Motion is not magnified if a body turns by more than a few degrees, because a rotation cannot
// be drawn larger.
(() => {
  const { minus, add, scaled, dot, length, apply, relative, turn } = steplap.geometry;
  const largestTurn = (3 * Math.PI) / 180;
  const drawnTurn = 0.1; // largest drawn rotation, rad; with more, joints would gape
  const drawnMotion = 0.05; // largest drawn motion, relative to the diagonal of the machine
  const drawnSpring = 1 / 3; // largest drawn deformation of a spring, relative to its drawn length
  const tiedSpring = 0.036; // drawn length of a spring whose ends coincide (springs.js), relative to the size of the machine
  // largest drawn motion relative to the clearance, so that no body is drawn through a wall that it does not touch
  const drawnClearance = 0.8;
  const most = 500; // largest factor; larger ones would show the compliance of contacts
  const steps = 120; // number of times at which a run is examined
  const alongside = '~alongside'; // name of the reference that moves along with a vehicle
  // Elements that connect a vehicle to the ground along its path, so that it cannot drive away.
  const holding = new Set(['pin', 'weld', 'rod', 'rope', 'bushing']);
  // elements that may connect the ground with a vehicle that drives away
  const rolling = new Set(['contact', 'edge_touch', 'faces', 'touch', 'friction', 'arrow']);
  const times = (scene) => Array.from({ length: steps + 1 }, (_, k) => (scene.run.end * k) / steps);
  const wayOf = (scene, name, t) => minus(scene.poseAt(name, t).slice(0, 2), scene.reference(name).slice(0, 2));

  // Returns the vehicle that a drive translates, { name, carried, travel(t) }, or null. Bodies that stay behind are drawn as if they moved
  // along, except a road on which wheels roll.
  function drivenBy(scene, drive, shape) {
    const name = shape.at[0].body, moving = [...scene.bodies.values()].filter((b) => b.moves && b.name !== name);
    const apart = new Map(moving.map((b) => [b.name, 0])), gone = new Map(apart);
    const most = (map, who, v) => map.set(who, Math.max(map.get(who), v));
    let far = 0;
    for (const t of times(scene)) {
      const way = wayOf(scene, name, t);
      far = Math.max(far, length(way));
      for (const body of moving) {
        const own = wayOf(scene, body.name, t);
        most(apart, body.name, length(minus(own, way)));
        most(gone, body.name, length(own));
      }
    }
    const carried = new Set([name, ...moving.filter((b) => apart.get(b.name) < 0.5 * far).map((b) => b.name)]);
    const axis = turn(shape.direction, 0);
    const isLevel = (s) => s.direction && Math.abs(dot(s.direction, axis)) > 0.7;
    const stays = (who) => scene.isHeld(who) || gone.get(who) < 0.3 * far;
    const isHeld = scene.elements.some((e) => e !== drive && e.shapes.some((s) => {
      const isBetween = s.at.some((p) => carried.has(p.body)) && s.at.some((p) => !carried.has(p.body) && stays(p.body));
      return isBetween && (holding.has(s.type) || (['spring', 'contact'].includes(s.type) && (!s.direction || isLevel(s))));
    }));
    const isVehicle = far > 0 && carried.size > 1 && 2 * carried.size >= moving.length + 1 && !isHeld;
    const rolls = (s) => s.type === 'edge_touch' && carried.has(s.at[0].body) && scene.isHeld(s.at[1].body);
    const isOnRoad = scene.elements.some((e) => e.shapes.some(rolls));
    return isVehicle ? { name, carried: isOnRoad ? null : carried, travel: (t) => scaled(axis, dot(axis, wayOf(scene, name, t))) } : null;
  }
  // Returns the bodies that drive away together without a drive. The ground is then drawn as passing by.
  function rollingAway(scene) {
    const moving = [...scene.bodies.values()].filter((b) => b.moves);
    const isOnGround = (e) => e.shapes.some((s) => s.at.some((p) => scene.isHeld(p.body)) && s.at.some((p) => !scene.isHeld(p.body)));
    if (moving.length < 2 || scene.elements.some((e) => isOnGround(e) && !e.shapes.every((s) => rolling.has(s.type)))) return null;
    const travel = (t) => scaled(moving.map((b) => wayOf(scene, b.name, t)).reduce(add), 1 / moving.length);
    let far = 0, apart = 0;
    for (const t of times(scene)) {
      const way = travel(t);
      far = Math.max(far, length(way));
      for (const b of moving) apart = Math.max(apart, length(minus(wayOf(scene, b.name, t), way)));
    }
    const largest = moving.reduce((a, b) => (b.reach > a.reach ? b : a));
    return far > scene.size && apart < 0.5 * scene.size ? { name: largest.name, carried: null, travel } : null;
  }
  // Returns for each body the names of the bodies connected to it by elements.
  function neighboursOf(scene) {
    const found = new Map(['ground', ...scene.bodies.keys()].map((name) => [name, new Set()]));
    for (const e of scene.run.drawing.elements) {
      const names = new Set([...(e.at || []).map((p) => p.body), e.limb, e.active_part].filter((name) => found.has(name)));
      for (const a of names)
        for (const b of names)
          if (a !== b) found.get(a).add(b);
    }
    return found;
  }
  const rounded = (wanted) => {
    const power = 10 ** Math.floor(Math.log10(wanted));
    return Math.min(most, power * (wanted / power >= 5 ? 5 : wanted / power >= 2 ? 2 : 1));
  };

  Object.assign(steplap.Scene.prototype, {
    // Returns { name, carried, travel } of the vehicle that drives away, or null. `carried` is null if all visible bodies move relative to
    // the ground.
    journey() {
      if (this.foundJourney !== undefined) return this.foundJourney;
      this.foundJourney = null;
      if (this.run.poseOf) return null;
      for (const e of this.elements) {
        const isAgainstGround = (s) => s.type === 'arrow' && s.direction && s.at.length > 1 && s.at[1].body === 'ground';
        const shape = e.kind === 'prescribed_motion' ? e.shapes.find(isAgainstGround) : null;
        const isLevel = shape && this.bodies.has(shape.at[0].body) && Math.abs(shape.direction[0]) > Math.abs(shape.direction[1]);
        if (isLevel) this.foundJourney = this.foundJourney || drivenBy(this, e, shape);
      }
      this.foundJourney = this.foundJourney || rollingAway(this);
      return this.foundJourney;
    },
    usualStandpoint() { return this.run.drawing.seen_from || (this.journey() ? alongside : 'ground'); },
    // Returns the references that the reader can select, as [name, text].
    standpoints() {
      const journey = this.journey(), bodies = [...this.bodies.keys()].slice(0, 40);
      return [...(journey ? [[alongside, `alongside ${journey.name}`]] : []), ...['ground', ...bodies].map((name) => [name, name])];
    },
    standpointText(seenFrom) {
      if (seenFrom === alongside) return this.journey() ? `moves along with ${this.journey().name}` : '';
      return seenFrom && seenFrom !== 'ground' ? `seen from ${seenFrom}` : '';
    },
    // Returns for each body the body that carries it: the neighbour nearest to the ground; of several, the largest.
    carriers() {
      if (this.foundCarriers) return this.foundCarriers;
      const neighbours = neighboursOf(this), level = new Map([['ground', 0]]), carriers = new Map();
      let front = ['ground', ...[...this.bodies.values()].filter((b) => b.fixed).map((b) => b.name)];
      for (const name of front) level.set(name, 0);
      while (front.length) {
        const next = new Set(front.flatMap((name) => [...neighbours.get(name)]).filter((name) => !level.has(name)));
        const reachOf = (name) => (name === 'ground' ? 0 : this.body(name).reach);
        const largest = (names) => names.reduce((a, b) => (reachOf(b) > reachOf(a) ? b : a));
        for (const name of next) carriers.set(name, largest([...neighbours.get(name)].filter((n) => front.includes(n))));
        for (const name of next) level.set(name, level.get(front[0]) + 1);
        front = [...next];
      }
      this.foundCarriers = carriers;
      return carriers;
    },
    // Returns the body relative to which the motion of `name` is drawn. Bodies that roll or turn over are skipped, because their load does
    // not turn with them.
    carrierOf(name) {
      let carrier = this.carriers().get(name) || 'ground';
      while (carrier !== 'ground' && this.largestTurnOf(carrier) > largestTurn) carrier = this.carriers().get(carrier) || 'ground';
      return carrier;
    },
    largestTurnOf(name) {
      const body = this.body(name);
      if (body.turned === undefined) body.turned = Math.max(...times(this).map((t) => Math.abs(body.poseAt(t)[2] - body.pose[2])));
      return body.turned;
    },
    // Returns the pose of a body at time t in ground axes, minus the travel of the followed vehicle.
    followedPose(name, t, seenFrom) {
      const pose = this.poseAt(name, t), journey = seenFrom === 'ground' ? null : this.journey();
      if (!journey || (journey.carried && !journey.carried.has(name))) return pose;
      return [...minus(pose.slice(0, 2), journey.travel(t)), pose[2]];
    },
    // Returns the pose of a body relative to its carrier, at rest and at time t.
    onCarrier(name, t, seenFrom) {
      const carrier = this.carrierOf(name);
      const followed = (who) => this.followedPose(who, t, seenFrom);
      return { rest: relative(this.reference(carrier), this.reference(name)), now: relative(followed(carrier), followed(name)) };
    },

    // --- magnification ------------------------------------------------------------------------------------
    // Returns the largest displacement of a body's points, m, and its largest rotation, rad, relative to its carrier.
    motionOf(body, seenFrom) {
      let displacement = 0, turned = 0;
      if (body.isUnrecorded) return { displacement: Infinity, turned };
      for (const t of times(this)) {
        const { rest, now } = this.onCarrier(body.name, t, seenFrom);
        turned = Math.max(turned, Math.abs(now[2] - rest[2]));
        for (const p of body.points) displacement = Math.max(displacement, length(minus(apply(now, p), apply(rest, p))));
      }
      return { displacement, turned };
    },
    // Returns the distance, m, by which a body can move to either side before it touches its carrier.
    clearanceOf(body) {
      const carrier = this.body(this.carrierOf(body.name)), rest = relative(carrier.pose, body.pose);
      let least = Infinity;
      if (carrier === this.ground) return least;
      for (const p of body.points) {
        const wall = steplap.forms.isInside(carrier, apply(rest, p)) ? this.wallOf(carrier) : 0;
        for (const d of [[1, 0], [-1, 0]]) {
          const hit = steplap.forms.crossings(carrier, [0, 0, 0], apply(rest, p), d).find((s) => s > 1e-3 * this.size);
          least = Math.min(least, hit === undefined ? Infinity : hit - wall);
        }
      }
      return Math.max(least, 0);
    },
    // Returns the drawn length of the shortest spring under a body that the ground carries.
    shortestSpring(body) {
      if (this.carrierOf(body.name) !== 'ground') return Infinity;
      const rest = (name) => this.reference(name), isUnder = (s) => s.type === 'spring' && s.at[0].body === body.name;
      const springs = this.elements.flatMap((e) => e.shapes.filter(isUnder));
      const lengthOf = ({ at: [a, b] }) => length(minus(this.placed(a, rest), this.placed(b, rest)));
      return Math.min(Infinity, ...springs.map((s) => Math.max(lengthOf(s), tiedSpring * this.size)));
    },
    // Returns the largest of 1, 2, 5, 10, … by which the motion of a body can be magnified within the bounds above; Infinity if it does not
    // move.
    factorAllowed(body, seenFrom) {
      const { displacement, turned } = this.motionOf(body, seenFrom);
      if (turned > largestTurn) return 1;
      const room = Math.min(drawnClearance * this.clearanceOf(body), drawnSpring * this.shortestSpring(body));
      const bound = Math.min(drawnMotion * length(this.still.span), room);
      const wanted = Math.min(bound / Math.max(displacement, 1e-12), drawnTurn / Math.max(turned, 1e-12));
      return wanted > most ? Infinity : wanted >= 1 ? rounded(wanted) : 1;
    },
    // Returns the factors by body name. Bodies on one carrier share the smallest factor, which is 1 if the motion of one is not recorded.
    usualFactors(seenFrom) {
      if (!this.factors) this.factors = new Map();
      if (this.factors.has(seenFrom)) return this.factors.get(seenFrom);
      const ofCarrier = new Map(), moving = [...this.bodies.values()].filter((b) => b.moves || b.isUnrecorded);
      for (const body of moving) {
        const carrier = this.carrierOf(body.name);
        const allowed = this.run.poseOf ? 1 : this.factorAllowed(body, seenFrom);
        ofCarrier.set(carrier, Math.min(ofCarrier.get(carrier) ?? Infinity, allowed));
      }
      const finite = (f) => (Number.isFinite(f) ? f : 1);
      const found = new Map(moving.map((b) => [b.name, finite(ofCarrier.get(this.carrierOf(b.name)))]));
      this.factors.set(seenFrom, found);
      return found;
    },
    isUsuallyMagnified(seenFrom) { return [...this.usualFactors(seenFrom).values()].some((f) => f > 1); },
    // Returns the magnification of a body. `magnification`: a number for all bodies, or 'usual'.
    factorOf(
      name, seenFrom, magnification) { return magnification === 'usual' ? this.usualFactors(seenFrom).get(name) ?? 1 : magnification; },
    // Returns the drawn poses at time t.
    look(t, seenFrom, magnification) {
      const cache = new Map(), compose = (a, b) => [...apply(a, b), a[2] + b[2]];
      const inGround = (name) => {
        if (cache.has(name)) return cache.get(name);
        let pose = this.followedPose(name, t, seenFrom);
        if (this.bodies.has(name) && !this.isHeld(name)) {
          const { rest, now } = this.onCarrier(name, t, seenFrom), f = this.factorOf(name, seenFrom, magnification);
          pose = compose(inGround(this.carrierOf(name)), rest.map((v, i) => v + f * (now[i] - v)));
        }
        cache.set(name, pose);
        return pose;
      };
      if (!this.bodies.has(seenFrom)) return inGround;
      const seen = new Map();
      return (name) => {
        if (!seen.has(name)) seen.set(name, compose(this.reference(seenFrom), relative(inGround(seenFrom), inGround(name))));
        return seen.get(name);
      };
    },
    // Returns the drawn pose of a body if it had not moved relative to its carrier since the start. Ground that passes by moves with the
    // distance driven.
    ghostPose(name, pose) {
      const carrier = this.carrierOf(name), rest = relative(this.reference(carrier), this.reference(name));
      const journey = this.seenFrom === 'ground' ? null : this.journey(),
            isPassing = Boolean(journey) && !journey.carried && this.isHeld(carrier);
      const on = isPassing ? this.reference(carrier) : pose(carrier);
      return [...apply(on, rest), on[2] + rest[2]];
    },
  });
  // Returns selection fields for magnification and reference; `scenes` are shown together.
  steplap.pictureChoices = (scenes, factor, from) => {
    const standpoint = scenes[0].usualStandpoint(), option = ([value, text]) => steplap.make('option', { value }, text);
    from.replaceChildren(...scenes[0].standpoints().map(option));
    from.value = standpoint;
    const isMagnified = scenes.some((scene) => scene.isUsuallyMagnified(standpoint));
    const numbers = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000].map((f) => [f, f === 1 ? 'true' : `${f} ×`]);
    factor.replaceChildren(...[...(isMagnified ? [['usual', 'enlarged']] : []), ...numbers].map(option));
    factor.value = isMagnified ? 'usual' : '1';
  };
  steplap.magnificationOf = (choice) => (choice.value === 'usual' ? 'usual' : Number(choice.value));
})();
