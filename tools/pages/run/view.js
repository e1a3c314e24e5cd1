// Zooming and panning of all pictures by wheel, dragging, two fingers, keys and buttons; saving of pictures and curves.
steplap.View = class View {
  constructor(scenes, redraw) {
    Object.assign(this, { scenes, redraw, zoom: 1, shift: [0, 0] });
    for (const scene of scenes) this.listen(scene);
  }
  set(zoom, shift) {
    this.zoom = Math.min(1e4, Math.max(0.2, zoom));
    this.shift = shift;
    for (const scene of this.scenes) {
      scene.setView({ zoom: this.zoom, shift: [...this.shift] });
      scene.spreadNames();
      scene.svg.classList.toggle('zoomed', this.zoom !== 1 || this.shift.some((v) => v !== 0));
    }
    this.redraw();
  }
  reset() { this.set(1, [0, 0]); }
  // Zooms about the pixel (x, y), which keeps its position.
  zoomAt(scene, factor, x = scene.width / 2, y = scene.height / 2) {
    const before = scene.toPlane(x, y), zoom = Math.min(1e4, Math.max(0.2, this.zoom * factor)), k = this.zoom / zoom;
    this.set(zoom, [0, 1].map((i) => this.shift[i] + (before[i] - scene.centre[i]) * (1 - k)));
  }
  pan(scene, dx, dy) { this.set(this.zoom, [this.shift[0] - dx / scene.scale, this.shift[1] + dy / scene.scale]); }

  listen(scene) {
    const svg = scene.svg, touches = new Map();
    const place = (event) => {
      const box = svg.getBoundingClientRect(), k = scene.width / box.width;
      return [(event.clientX - box.left) * k, (event.clientY - box.top) * k];
    };
    const middle = () => {
      const all = [...touches.values()];
      return [0, 1].map((i) => all.reduce((sum, p) => sum + p[i], 0) / all.length);
    };
    const spread = () => {
      const [a, b] = [...touches.values()];
      return Math.hypot(a[0] - b[0], a[1] - b[1]);
    };
    svg.addEventListener('wheel', (event) => {
      // The wheel scrolls the page; it zooms with Ctrl, or once the picture has been clicked.
      if (!event.ctrlKey && document.activeElement !== svg) return;
      event.preventDefault();
      this.zoomAt(scene, Math.exp(-0.0015 * event.deltaY * (event.deltaMode ? 30 : 1)), ...place(event));
    }, { passive: false });
    svg.addEventListener('pointerdown', (event) => {
      if (event.pointerType === 'mouse' && event.button !== 0) return;
      touches.set(event.pointerId, place(event));
      svg.focus({ preventScroll: true });
      // One finger scrolls the page while the whole machine is visible. Two fingers, or one finger on an enlarged part, move the picture.
      if (event.pointerType !== 'touch' || touches.size > 1 || svg.classList.contains('zoomed')) svg.setPointerCapture(event.pointerId);
    });
    svg.addEventListener('pointermove', (event) => {
      if (!touches.has(event.pointerId)) return;
      if (event.pointerType === 'touch' && touches.size < 2 && !svg.classList.contains('zoomed')) return;
      const from = middle(), wide = touches.size === 2 ? spread() : 0;
      touches.set(event.pointerId, place(event));
      const to = middle();
      this.pan(scene, to[0] - from[0], to[1] - from[1]);
      if (wide > 0) this.zoomAt(scene, spread() / wide, ...to);
    });
    for (const name of ['pointerup', 'pointercancel', 'lostpointercapture'])
      svg.addEventListener(name, (event) => touches.delete(event.pointerId));
    svg.addEventListener('dblclick', () => this.reset());
    svg.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey) return;
      const step = 0.1 * scene.width, pans = { ArrowLeft: [step, 0], ArrowRight: [-step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] };
      if (event.key === '+' || event.key === '=') this.zoomAt(scene, 1.25);
      else if (event.key === '-') this.zoomAt(scene, 0.8);
      else if (event.key === '0') this.reset();
      else if (event.key in pans && svg.classList.contains('zoomed')) this.pan(scene, ...pans[event.key]);
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
  }
};

steplap.save = (() => {
  const looks = [
    'fill', 'fill-opacity', 'stroke', 'stroke-width', 'stroke-dasharray', 'stroke-linecap', 'stroke-linejoin', 'stroke-opacity', 'opacity',
    'vector-effect', 'font-family', 'font-size', 'font-weight', 'text-anchor', 'dominant-baseline', 'paint-order', 'display'
  ];
  // Offers a file for download.
  function file(name, type, content) {
    const link = document.createElement('a'), url = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
    link.href = url;
    link.download = name.replace(/[^\w.-]+/g, '_');
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(url), 10000);
  }
  // Returns a copy of a drawing with all computed styles, so that it can be saved alone.
  function alone(svg) {
    const copy = svg.cloneNode(true), from = [svg, ...svg.querySelectorAll('*')], to = [copy, ...copy.querySelectorAll('*')];
    from.forEach((node, i) => {
      const style = getComputedStyle(node);
      to[i].setAttribute('style', looks.map((name) => `${name}:${style.getPropertyValue(name)}`).join(';'));
      for (const name of ['class', 'tabindex', 'role']) to[i].removeAttribute(name);
    });
    const [, , width, height] = svg.getAttribute('viewBox').split(' ').map(Number);
    copy.removeAttribute('style');
    for (const [name, value] of Object.entries({ xmlns: 'http://www.w3.org/2000/svg', width, height })) copy.setAttribute(name, value);
    copy.prepend(steplap.make('rect', { width, height, fill: getComputedStyle(document.body).backgroundColor }));
    return { text: new XMLSerializer().serializeToString(copy), width, height };
  }
  const svg = (drawing, name) => file(`${name}.svg`, 'image/svg+xml', alone(drawing).text);
  // Returns a promise of a canvas with the drawing.
  async function raster(drawing, magnified) {
    const { text, width, height } = alone(drawing), image = new Image(), canvas = document.createElement('canvas');
    image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
    await image.decode();
    canvas.width = magnified * width;
    canvas.height = magnified * height;
    canvas.getContext('2d').drawImage(image, 0, 0, canvas.width, canvas.height);
    return canvas;
  }
  async function png(drawing, name, magnified = 2) {
    const canvas = await raster(drawing, magnified);
    canvas.toBlob((blob) => file(`${name}.png`, 'image/png', blob), 'image/png');
  }
  // Returns buttons for saving: { SVG: action, ... }.
  function buttons(actions) {
    const box = steplap.make('span', { class: 'save' }, 'Save: ');
    for (const [label, action] of Object.entries(actions)) {
      const button = steplap.make('button', { type: 'button', 'data-save': label.toLowerCase() }, label);
      button.addEventListener('click', action);
      box.append(button, ' ');
    }
    return box;
  }
  return { file, svg, png, raster, alone, buttons };
})();

// Returns an icon as a drawing, because a font may lack the character.
steplap.icon = (name) => {
  const shapes = {
    play: 'M4 2L13 8L4 14Z',
    pause: 'M4 2H7V14H4ZM9 2H12V14H9Z',
    closer: 'M7 2H9V7H14V9H9V14H7V9H2V7H7Z',
    further: 'M2 7H14V9H2Z',
    whole: 'M2 2H6V4H4V6H2ZM10 2H14V6H12V4H10ZM2 10H4V12H6V14H2ZM12 10H14V14H10V12H12Z'
  };
  return steplap.make('svg', { viewBox: '0 0 16 16', class: 'icon', 'aria-hidden': 'true' }, steplap.make('path', { d: shapes[name] }));
};
