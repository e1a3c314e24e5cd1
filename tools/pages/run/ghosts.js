// Draws the initial poses of displaced bodies with dashed lines, relative to the body that carries them.
(() => {
  const make = steplap.make, { minus, length, apply } = steplap.geometry;
  const least = 3; // smallest displacement, pixels, for which the initial pose is drawn
  const most = 40; // largest number of bodies with a drawn initial pose

  Object.assign(steplap.Scene.prototype, {
    addGhost(body) {
      if (this.bodies.size > most || !body.moves || body.isPoint) return;
      const shapes = this.shapesOf(body).filter((shape) => !shape.classList.contains('spoke'));
      const group = make('g', { class: 'ghost', 'data-ghost-of': body.name }, ...shapes);
      this.ghostLayer.append(group);
      this.updaters.push((t, pose) => {
        const isSeen = this.shiftOf(body, pose) * this.scale > least;
        group.style.display = isSeen ? '' : 'none';
        if (isSeen) this.putAt(group, this.ghostPose(body.name, pose));
      });
    },
    // Returns the displacement of a body as drawn, m.
    shiftOf(body, pose) {
      const at = this.ghostPose(body.name, pose), now = pose(body.name);
      return Math.max(0, ...body.points.map((p) => length(minus(apply(at, p), apply(now, p)))));
    },
    // Moves a drawing from body axes to the given pose.
    putAt(group, [x, y, angle]) {
      const c = this.scale * Math.cos(angle), s = this.scale * Math.sin(angle), [sx, sy] = this.toScreen([x, y]);
      group.setAttribute('transform', `matrix(${c} ${- s} ${- s} ${- c} ${sx} ${sy})`);
    },
  });
})();
