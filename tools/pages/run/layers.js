// Switches for the layers of a picture, such as names, forces or springs. A switch applies to all pictures in a box.
steplap.layers = (() => {
  const make = steplap.make;
  const all = [
    ['names', 'Names'], ['forces', 'Forces'], ['springs', 'Springs'], ['contacts', 'Contacts'], ['markers', 'Markers'],
    ['ghosts', 'Start pose']
  ];
  function build(box, pictures) {
    for (const [name, text] of all) {
      const choice = make('input', { type: 'checkbox', checked: '', 'data-layer': name });
      choice.addEventListener('change', () => pictures.classList.toggle(`without-${name}`, !choice.checked));
      box.append(make('label', {}, choice, ` ${text}`));
    }
  }
  return { build };
})();
