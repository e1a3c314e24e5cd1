// Sentences about things: "rear foot lifts", "rear wheels lift".
steplap.words = (() => {
  const
    plurals = { lifts: 'lift', opens: 'open', breaks: 'break', 'comes apart': 'come apart', slips: 'slip', slides: 'slide', tips: 'tip' };
  // As the program's own sentences (run/story.cpp).
  const isPlural = (name) => name.endsWith('feet') || /[^aisu]s$/.test(name);
  const sentence = (name, verb) => `${name} ${isPlural(name) ? plurals[verb] || verb : verb}`;
  return { sentence };
})();
