// Sentences about elements: "rear foot lifts", "rear wheels lift".
steplap.words = (() => {
  const
    plurals = { lifts: 'lift', opens: 'open', breaks: 'break', 'comes apart': 'come apart', slips: 'slip', slides: 'slide', tips: 'tip' };
  // The same rule as in the program's own sentences (run/story.cpp).
  const isPlural = (name) => name.endsWith('feet') || /[^aisu]s$/.test(name);
  const sentence = (name, verb) => `${name} ${isPlural(name) ? plurals[verb] || verb : verb}`;
  return { sentence };
})();
