// Measures the page it is in, uses its figures, and sends the results to the window around it. For tests/diagnosis/report_page.rs.
'use strict';
(() => {
  const errors = [];
  addEventListener('error', (e) => errors.push(String(e.message)));
  const scale = (element) => {
    const m = element.getScreenCTM && element.getScreenCTM();
    return m ? Math.hypot(m.a, m.b) : 1;
  };
  const visible = (e) => e.getClientRects().length > 0 && getComputedStyle(e).visibility !== 'hidden';
  const measure = () => {
    let smallest = Infinity;
    let where = '';
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
      const e = node.parentElement;
      if (!node.textContent.trim() || ['SCRIPT', 'STYLE', 'NOSCRIPT'].includes(e.tagName) || !visible(e)) continue;
      const size = parseFloat(getComputedStyle(e).fontSize) * (e.ownerSVGElement ? scale(e) : 1);
      if (size < smallest) [smallest, where] = [size, `${e.tagName} ${node.textContent.slice(0, 40)}`];
    }
    const outside = [];
    const width = document.documentElement.clientWidth;
    for (const svg of document.querySelectorAll('svg')) {
      const box = svg.getBoundingClientRect();
      if (box.right > width + 0.5) outside.push(`svg to ${box.right}`);
      for (const t of svg.querySelectorAll('text')) {
        const b = t.getBoundingClientRect();
        if (b.width && (b.left < box.left - 1 || b.right > box.right + 1 || b.top < box.top - 1 || b.bottom > box.bottom + 1)) {
          outside.push(`${t.textContent} in ${svg.getAttribute('aria-label')}`);
        }
      }
    }
    return { smallest, where, outside, width, content: document.documentElement.scrollWidth };
  };
  const use = () => {
    const fire = (type, fx, fy) => {
      const svg = document.querySelectorAll('#run-picture svg.plot')[1];
      const box = svg.getBoundingClientRect();
      svg.dispatchEvent(new PointerEvent(type, { bubbles: true, clientX: box.left + fx * box.width, clientY: box.top + fy * box.height, pointerId: 1 }));
    };
    Element.prototype.setPointerCapture = () => {};
    fire('pointermove', 0.6, 0.4);
    const tip = !document.querySelector('.tip').hidden && document.querySelector('.tip').textContent.length > 5;
    const labels = () => [...document.querySelectorAll('#run-picture svg.plot')].map((s) => s.textContent).join('|');
    const before = labels();
    fire('pointerdown', 0.4, 0.3);
    fire('pointermove', 0.7, 0.6);
    fire('pointerup', 0.7, 0.6);
    const zoomed = labels() !== before;
    const button = document.querySelector('#run-picture button');
    const offered = !button.hidden;
    button.click();
    const reset = offered && button.hidden && labels() === before;
    const select = document.querySelector('#run-picture select');
    select.value = String((select.selectedIndex + 1) % select.options.length);
    const paths = () => [...document.querySelectorAll('#run-picture path')].map((p) => p.getAttribute('d')).join('');
    const drawn = paths();
    select.dispatchEvent(new Event('change'));
    return { tip, zoomed, reset, runs: select.options.length, changed: paths() !== drawn, panels: document.querySelectorAll('svg.plot').length };
  };
  addEventListener('load', () => {
    document.querySelectorAll('details').forEach((d) => (d.open = true));
    let told = measure();
    try {
      told = { ...told, ...use() };
    } catch (e) {
      errors.push(String(e.stack));
    }
    parent.postMessage(JSON.stringify({ ...told, errors }), '*');
  });
})();
