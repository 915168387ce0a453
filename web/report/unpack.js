// Unpacks the viewer and the data of the page: bytesOfText is before this, in the same script.
(async () => {
  const app = document.getElementById('app');
  if (!self.DecompressionStream) return app.append('This page needs a browser of 2023 or later.');
  const packed = new Blob([bytesOfText(document.getElementById('viewer').textContent)]).stream().pipeThrough(new DecompressionStream('deflate'));
  const [style, script, colors, content] = (await new Response(packed).text()).split('\0');
  const add = (name, text, more) => document.body.append(Object.assign(document.createElement(name), { textContent: text }, more));
  add('style', style);
  add('script', content, { type: 'application/json', id: 'content' });
  document.getElementById('content').dataset.colors = colors;
  add('script', script, { type: 'module' });
})();
