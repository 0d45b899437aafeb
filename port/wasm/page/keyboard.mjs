// Keys for all that the controls do; none while a hand types.

/// actions: key -> {words, act}; help: where the list stands.
export function listenToKeys(actions, help, element) {
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || isTaken(event.key, event.target)) return;
    const action = actions.get(event.key) ?? actions.get(event.key.toLowerCase());
    if (!action) return;
    event.preventDefault();
    action.act();
  });
  help.replaceChildren(...[...actions].filter(([, {words}]) => words).map(([key, {words, shown}]) => element(
    'div', {}, element('dt', {}, element('kbd', {}, shown ?? key)), element('dd', {}, words))));
}

/// Whether the element with the focus has its own use for a key.
function isTaken(key, {tagName, type}) {
  if (tagName === 'TEXTAREA' || tagName === 'SELECT') return true;
  if (tagName === 'BUTTON' || tagName === 'SUMMARY') return key === ' ' || key === 'Enter';
  if (tagName !== 'INPUT') return false;
  const isHand = type === 'range' || type === 'checkbox' || type === 'radio';
  return !isHand || key === ' ' || key.startsWith('Arrow');
}
