// Signs for events. They are drawn, not typed, and always accompanied by a word, so that none depends on colour alone.
steplap.signs = (() => {
  const make = steplap.make;
  // Drawings of 16 × 16 pixels; `colour` is the style class.
  const signs = {
    slip: { word: 'slips', colour: 'bad', d: 'M1 13H15V14.6H1ZM2 8H9V4.6L15 9L9 13V10H2Z' },
    stick: { word: 'sticks', colour: 'good', d: 'M1 13H15V14.6H1ZM4 6V4.5A4 4 0 0 1 12 4.5V6H13V12H3V6ZM6 6H10V4.5A2 2 0 0 0 6 4.5Z' },
    open: { word: 'opens', colour: 'plain', d: 'M1 13H15V14.6H1ZM8 1L12.5 6H9.3V11.5H6.7V6H3.5Z' },
    close: { word: 'closes', colour: 'plain', d: 'M1 13H15V14.6H1ZM8 12L3.5 7H6.7V1.5H9.3V7H12.5Z' },
    strike: { word: 'strikes', colour: 'warn', d: 'M13 1H15V15H13ZM1 6.7H7V3.5L12 8L7 12.5V9.3H1Z' },
    break: { word: 'breaks', colour: 'bad', d: 'M1 6H6L4.5 8L7 10H1ZM15 10H10L11.5 8L9 6H15Z' },
    apart: { word: 'comes apart', colour: 'bad', d: 'M1 5L5 8L1 11ZM15 5L11 8L15 11ZM7.2 1H8.8V15H7.2Z' },
    tip: { word: 'tips', colour: 'bad', d: 'M1 13H15V14.6H1ZM6 12L2.5 5L10 1.5L13.5 8.5Z' },
    free: { word: 'comes free', colour: 'plain', d: 'M8 3A5 5 0 1 1 7.9 3ZM8 5A3 3 0 1 0 8.1 5Z' },
    other: { word: '', colour: 'plain', d: 'M8 4A4 4 0 1 1 7.9 4Z' },
  };
  // Sign of each word of the summary's story.
  const byWord = {
    slips: 'slip',
    slides: 'slip',
    sticks: 'stick',
    lifts: 'open',
    'lifts off': 'open',
    opens: 'open',
    closes: 'close',
    touches: 'close',
    strikes: 'strike',
    hits: 'strike',
    breaks: 'break',
    'comes apart': 'apart',
    tips: 'tip'
  };
  const ofWord = (word) => byWord[word] || 'other';
  // Returns the sign as an element to be placed next to text.
  const icon = (name) =>
    make('svg', { viewBox: '0 0 16 16', class: `sign ${signs[name].colour}`, 'aria-hidden': 'true', 'data-sign': name },
      make('path', { d: signs[name].d, 'fill-rule': 'evenodd' }));
  // Returns the sign as part of a drawing, centred at (x, y).
  function mark(name, x, y, size) {
    const path = make(
      'path', { d: signs[name].d, 'fill-rule': 'evenodd', transform: `translate(${x - size / 2} ${y - size / 2}) scale(${size / 16})` });
    return make('g', { class: `sign ${signs[name].colour}`, 'data-sign': name },
      make('rect', { x: x - size / 2 - 1, y: y - size / 2 - 1, width: size + 2, height: size + 2, rx: 3, class: 'behind' }), path);
  }
  // Importance for choosing one sign that represents several, the most important first.
  const ranks = ['break', 'apart', 'tip', 'slip', 'strike', 'open', 'stick', 'close', 'free', 'other'];
  const worst = (names) => ranks.find((name) => names.includes(name)) || 'other';
  const wordOf = (name) => signs[name].word;
  const has = (name) => name in signs;
  return { icon, mark, worst, ofWord, wordOf, has };
})();
