// Sentences about elements: "rear foot lifts", "rear wheels lift".
steplap.words = (() => {
  const
    plurals = { lifts: 'lift', opens: 'open', breaks: 'break', 'comes apart': 'come apart', slips: 'slip', slides: 'slide', tips: 'tip' };
  // Returns true for a plural name, by the same rule as in the program (run/story.cpp).
  const isPlural = (name) => name.endsWith('feet') || /[^aisu]s$/.test(name);
  const sentence = (name, verb) => `${name} ${isPlural(name) ? plurals[verb] || verb : verb}`;
  return { sentence };
})();
