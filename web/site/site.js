// The theme and the search. A classic script, which also runs in pages of files.
(() => {
  const themes = ['auto', 'light', 'dark'], button = document.getElementById('theme'), root = document.body.dataset.root;
  const store = (() => { try { return window.localStorage; } catch { return null; } })();
  function setTheme(theme) {
    document.documentElement.dataset.theme = theme;
    button.textContent = `Theme: ${theme}`;
    try { store?.setItem('theme', theme); } catch { /* a page of a file may have no storage */ }
  }
  button.addEventListener('click', () => setTheme(themes[(themes.indexOf(document.documentElement.dataset.theme) + 1) % 3]));
  let kept = null;
  try { kept = store?.getItem('theme'); } catch { /* as above */ }
  if (themes.includes(kept)) setTheme(kept);

  const input = document.querySelector('.search input'), list = document.querySelector('.search ol');
  const entries = window.searchIndex.map((entry) => ({ ...entry, head: `${entry.title} ${entry.heading}`.toLowerCase(), body: entry.text.toLowerCase() }));

  /// Every word must occur; words of headings count most.
  function find(words) {
    return entries.map((entry) => {
      let score = 0;
      for (const word of words) {
        const inHead = entry.head.includes(word), inText = entry.body.split(word).length - 1;
        if (!inHead && !inText) return null;
        score += (inHead ? 20 : 0) + Math.min(inText, 5) + (entry.heading.toLowerCase() === word ? 40 : 0);
      }
      return { entry, score };
    }).filter(Boolean).sort((a, b) => b.score - a.score).slice(0, 12).map(({ entry }) => entry);
  }

  function excerpt(text, word) {
    const at = Math.max(0, text.toLowerCase().indexOf(word) - 40);
    return (at ? '… ' : '') + text.slice(at, at + 130) + (at + 130 < text.length ? ' …' : '');
  }

  function show() {
    const words = input.value.toLowerCase().split(/\s+/).filter(Boolean), found = words.length ? find(words) : [];
    list.hidden = !words.length;
    list.replaceChildren(...found.map((entry) => {
      const item = document.createElement('li'), link = document.createElement('a'), title = document.createElement('strong'), text = document.createElement('span');
      link.href = `${root}/${entry.page}`;
      title.textContent = entry.heading && entry.heading !== entry.title ? `${entry.title}: ${entry.heading}` : entry.title;
      text.textContent = excerpt(entry.text, words[0]);
      link.append(title, text);
      item.append(link);
      return item;
    }));
    if (words.length && !found.length) {
      const item = document.createElement('li');
      item.textContent = 'Nothing was found.';
      list.append(item);
    }
  }
  input.addEventListener('input', show);
  input.addEventListener('focus', show);
  input.addEventListener('keydown', (event) => {
    if (event.key === 'Enter') list.querySelector('a')?.click();
    if (event.key === 'ArrowDown') list.querySelector('a')?.focus(), event.preventDefault();
    if (event.key === 'Escape') input.blur(), list.hidden = true;
  });
  list.addEventListener('keydown', (event) => {
    const step = { ArrowDown: 'nextElementSibling', ArrowUp: 'previousElementSibling' }[event.key];
    if (event.key === 'Escape') list.hidden = true, input.focus();
    if (!step) return;
    event.preventDefault();
    (document.activeElement.closest('li')?.[step]?.querySelector('a') ?? input).focus();
  });
  document.addEventListener('click', (event) => { if (!event.target.closest('.search')) list.hidden = true; });
  document.addEventListener('keydown', (event) => {
    if (event.key !== '/' || event.target.closest('input, textarea, select') || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    input.focus();
  });
})();
