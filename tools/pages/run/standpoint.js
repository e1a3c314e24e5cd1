// From where a machine is seen, and how far its motion is magnified.
//
// It is seen from the ground, unless a drive translates a vehicle that carries the rest: then from the vehicle, and what
// stays behind (the ground, strips of road) is drawn as if it came along, so that springs and wheels stay above their road.
// Motion is not magnified where a body turns by more than a few degrees: a turn cannot be drawn larger than it is.
(() => {
  const { minus, add, scaled, dot, length, apply, relative, turn } = steplap.geometry;
  const largestTurn = (3 * Math.PI) / 180;
  const drawnTurn = 0.1; // rad, of what is magnified: joints of what turns further would gape
  const most = 1000; // what would need more is no motion, but how far contacts give way
  const steps = 120; // at which a run is looked at
  // Of shapes that hold the vehicle to the ground along its way, which it then does not leave behind.
  const holding = new Set(['pin', 'weld', 'rod', 'rope', 'bushing']);

  // The drive, its direction, and who goes along.
  function journeyOf(scene, drive, shape) {
    const name = shape.at[0].body, run = scene.run, moving = [...scene.bodies.values()].filter((b) => b.moves && b.name !== name);
    const wayOf = (who, t) => minus(scene.poseAt(who, t), scene.reference(who)), apart = new Map(moving.map((b) => [b.name, 0]));
    let far = 0;
    for (let k = 0; k <= steps; ++k) {
      const t = (run.end * k) / steps, way = wayOf(name, t);
      far = Math.max(far, length(way));
      for (const body of moving) apart.set(body.name, Math.max(apart.get(body.name), length(minus(wayOf(body.name, t), way))));
    }
    const carried = new Set([name, ...moving.filter((b) => apart.get(b.name) < 0.3 * far).map((b) => b.name)]);
    const axis = turn(shape.direction, 0);
    const isLevel = (s) => s.direction && Math.abs(dot(s.direction, axis)) > 0.7;
    const isHeld = scene.elements.some((e) => e !== drive && e.shapes.some((s) => {
      const on = s.at.filter((p) => carried.has(p.body)).length;
      return on > 0 && on < s.at.length && (holding.has(s.type) || (['spring', 'contact'].includes(s.type) && (!s.direction || isLevel(s))));
    }));
    const isVehicle = far > 0 && carried.size > 1 && 2 * carried.size >= moving.length + 1 && !isHeld;
    return isVehicle ? { name, axis, carried } : null;
  }

  Object.assign(steplap.Scene.prototype, {
    // { name, axis, carried } of the vehicle that a drive translates, or null.
    journey() {
      if (this.foundJourney !== undefined) return this.foundJourney;
      this.foundJourney = null;
      for (const e of this.elements) {
        const shape = e.kind === 'prescribed_motion' && !this.run.poseOf ? e.shapes.find((s) => s.type === 'arrow' && s.direction && s.at.length > 1 && s.at[1].body === 'ground') : null;
        if (shape && this.bodies.has(shape.at[0].body) && Math.abs(shape.direction[0]) > Math.abs(shape.direction[1])) this.foundJourney = this.foundJourney || journeyOf(this, e, shape);
      }
      return this.foundJourney;
    },
    usualStandpoint() {
      const wanted = this.run.drawing.seen_from, journey = this.journey();
      return wanted || (journey ? journey.name : 'ground');
    },
    // Pose of a body as the standpoint sees it at time t, the frame that stands for it at rest being its reference pose.
    seenPose(name, t, seenFrom) {
      const journey = this.journey(), isLeft = journey && journey.carried.has(seenFrom) && !journey.carried.has(name);
      let from = this.poseAt(seenFrom, t);
      if (isLeft) {
        const back = scaled(journey.axis, -dot(journey.axis, minus(from, this.reference(seenFrom))));
        from = [...add(from, back), from[2]];
      }
      return relative(from, this.poseAt(name, t));
    },
    // Largest displacement of any outline against the reference, and largest turn, seen from a body.
    largestMotion(seenFrom) {
      let displacement = 0, turned = 0;
      const r0 = this.reference(seenFrom);
      for (let k = 0; k <= steps; ++k) {
        const t = (this.run.end * k) / steps;
        for (const body of this.bodies.values()) {
          // One whose motion is not written is drawn where it begins: from a body that moves it is seen to move.
          if (!body.moves && !(body.isUnrecorded && this.body(seenFrom).moves)) continue;
          const a = relative(r0, body.pose), b = this.seenPose(body.name, t, seenFrom);
          turned = Math.max(turned, Math.abs(b[2] - a[2]));
          for (const p of body.points) displacement = Math.max(displacement, length(minus(apply(b, p), apply(a, p))));
        }
      }
      return { displacement, turned };
    },
    // 1, 2, 5, 10 …: the largest displacement becomes some twentieth of the picture.
    usualMagnification(seenFrom) {
      const { displacement, turned } = this.largestMotion(seenFrom), wanted = Math.min((0.06 * this.size) / Math.max(displacement, 1e-12), drawnTurn / Math.max(turned, 1e-12));
      if (!(wanted > 1.5) || wanted > 20 * most || turned > largestTurn) return 1;
      const power = 10 ** Math.floor(Math.log10(wanted));
      return Math.min(most, power * (wanted / power >= 5 ? 5 : wanted / power >= 2 ? 2 : 1));
    },
    // Poses as drawn at time t.
    look(t, seenFrom, magnification) {
      const r0 = this.reference(seenFrom), cache = new Map();
      return (name) => {
        if (cache.has(name)) return cache.get(name);
        const a = relative(r0, this.reference(name)), b = this.seenPose(name, t, seenFrom);
        const drawn = a.map((v, i) => v + magnification * (b[i] - v)), pose = [...apply(r0, drawn), drawn[2] + r0[2]];
        cache.set(name, pose);
        return pose;
      };
    },
  });
})();
