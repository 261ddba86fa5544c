// Draws the figures of a report from the numbers in the page: panels that fit the width, with hover, zoom and a run to choose.
// It computes nothing about ships: what is drawn, in which colours and ranges, is in the JSON beside it. Nothing is loaded.
'use strict';
(() => {
  const source = document.getElementById('figures');
  if (!source) return;
  const data = JSON.parse(source.textContent);
  // The name space of SVG, from an element that has it.
  const NS = new DOMParser().parseFromString('<svg></svg>', 'text/html').querySelector('svg').namespaceURI;
  const SMALL = 12;
  const pen = document.createElement('canvas').getContext('2d');
  const family = getComputedStyle(document.body).fontFamily;
  const width = (text, size = SMALL, bold = '') => ((pen.font = `${bold} ${size}px ${family}`), pen.measureText(text).width);
  const add = (parent, name, attributes = {}, text) => {
    const e = document.createElementNS(NS, name);
    for (const key in attributes) e.setAttribute(key, attributes[key]);
    if (text !== undefined) e.textContent = text;
    return parent.appendChild(e);
  };
  const html = (parent, name, className, text) => {
    const e = document.createElement(name);
    if (className) e.className = className;
    if (text !== undefined) e.textContent = text;
    return parent.appendChild(e);
  };
  const ink = (color) => `var(--c-${color.slice(1)}, ${color})`;
  const minus = (text) => text.replace('-', '\u2212');
  // A number with four digits that count.
  const number = (v) => {
    if (v === null || !isFinite(v)) return '\u2013';
    const size = Math.abs(v);
    if (size !== 0 && (size < 1e-3 || size >= 1e6)) return minus(v.toExponential(3));
    const decimals = size === 0 ? 0 : Math.max(0, 3 - Math.floor(Math.log10(size)));
    return minus(v.toFixed(Math.min(decimals, 6)));
  };

  // Lines of a text that are at most so wide.
  const lines = (text, limit, size = SMALL) => {
    const out = [];
    for (const word of text.split(' ')) {
      const last = out.length - 1;
      if (last >= 0 && width(`${out[last]} ${word}`, size) <= limit) out[last] += ` ${word}`;
      else out.push(word);
    }
    return out;
  };

  const nice = (atLeast) => {
    const power = 10 ** Math.floor(Math.log10(atLeast));
    return [1, 2, 5, 10].map((m) => m * power).find((s) => s >= atLeast * (1 - 1e-9)) || atLeast;
  };
  // The smallest step of an axis that is at least `atLeast`: those of a compass for angles beyond 10 deg.
  const stepOf = (axis, atLeast) =>
    (axis.g && atLeast > 10 && [15, 30, 45, 90, 180, 360].find((s) => s >= atLeast * (1 - 1e-9))) || nice(atLeast);
  // Ticks of an axis over a range `length` px long: values, labels, and the power of ten they share.
  const ticks = (axis, [lo, hi], length, room) => {
    if (axis.k === 'cat') return { at: axis.c.map((label, i) => [i, label]), power: 0 };
    if (axis.k === 'log') {
      const [a, b] = [Math.log10(lo), Math.log10(hi)];
      const steps = b - a < 1.2 ? [1, 2, 3, 5, 7] : b - a < 2.5 ? [1, 2, 5] : [1];
      const at = [];
      for (let e = Math.floor(a); e <= b; e++) {
        for (const m of steps) {
          const v = m * 10 ** e;
          if (v >= lo * (1 - 1e-9) && v <= hi * (1 + 1e-9)) at.push([v, v >= 1e-3 && v < 1e5 ? String(+v.toPrecision(3)) : v.toExponential(0)]);
        }
      }
      if (at.length >= 3) return { at: at.filter((_, i) => i % Math.ceil((at.length * room) / length) === 0), power: 0 };
    }
    // An axis with a tick step beyond its range is to have no ticks.
    if (axis.e > axis.r[1] - axis.r[0]) return { at: [], power: 0 };
    let step = axis.e && (hi - lo) / axis.e < 40 && (hi - lo) / axis.e >= 2 ? axis.e : stepOf(axis, ((hi - lo) * room) / length);
    const values = (by) => {
      const first = Math.ceil(lo / by - 1e-9);
      const count = Math.floor(hi / by + 1e-9) - first;
      return Array.from({ length: Math.max(0, Math.min(60, count + 1)) }, (_, i) => (first + i) * by);
    };
    for (let k = 0; k < 4 && values(step).length < 3; k++) step = stepOf(axis, step / 2.6);
    // Of ticks that are finer than their labels have room, every second one where three are left.
    if (values(step).length * room > 1.25 * length && values(2 * step).length >= 3) step *= 2;
    const all = values(step);
    const largest = Math.max(...all.map(Math.abs), 0);
    const power = largest >= 1e5 || (largest > 0 && largest < 1e-3) ? 3 * Math.floor(Math.log10(largest) / 3 + 1e-12) : 0;
    const scaled = step / 10 ** power;
    let decimals = 0;
    while (decimals < 9 && Math.abs(scaled * 10 ** decimals - Math.round(scaled * 10 ** decimals)) > 1e-6) decimals++;
    return { at: all.map((v) => [v, minus((v / 10 ** power || 0).toFixed(decimals))]), power };
  };

  const dashes = (layer) => ['', '7 4', '1.5 3.5'][layer.d || 0];
  const marker = (parent, shape, x, y, r, style) => {
    const paths = {
      square: `M${x - r} ${y - r}h${2 * r}v${2 * r}h${-2 * r}z`,
      diamond: `M${x} ${y - 1.3 * r}l${1.3 * r} ${1.3 * r}l${-1.3 * r} ${1.3 * r}l${-1.3 * r} ${-1.3 * r}z`,
      triangle: `M${x} ${y - 1.2 * r}l${1.15 * r} ${2 * r}h${-2.3 * r}z`,
      cross: `M${x - r} ${y - r}l${2 * r} ${2 * r}m0 ${-2 * r}l${-2 * r} ${2 * r}`,
    };
    if (!paths[shape]) return add(parent, 'circle', { cx: x, cy: y, r, style: `fill:${style}` });
    return add(parent, 'path', { d: paths[shape], style: shape === 'cross' ? `fill:none;stroke:${style};stroke-width:2` : `fill:${style}` });
  };

  const tip = html(document.body, 'div', 'tip');
  tip.hidden = true;
  const showTip = (event, rows) => {
    tip.replaceChildren();
    rows.forEach((row) => html(tip, 'div', '', row));
    tip.hidden = false;
    const box = tip.getBoundingClientRect();
    tip.style.left = `${Math.max(4, Math.min(event.clientX + 14, document.documentElement.clientWidth - box.width - 8))}px`;
    tip.style.top = `${Math.max(4, event.clientY - box.height - 12)}px`;
  };

  // One panel: axes and layers at a given width. `view` contains the ranges shown, which zooming changes.
  class Panel {
    constructor(figure, spec, host) {
      Object.assign(this, { figure, spec, host, view: null });
      this.draw(320);
    }

    range(axis, which) {
      return (this.view && this.view[which]) || axis.r;
    }

    draw(W) {
      const { spec, host } = this;
      this.W = W;
      host.replaceChildren();
      if (spec.t) html(host, 'h4', '', spec.t);
      const rows = spec.y.k === 'cat' ? spec.y.c.map((label) => lines(label, 0.42 * W)) : null;
      const heat = spec.s.some((l) => l.k === 'heat');
      const columns = spec.x.k === 'cat' ? spec.x.c : null;
      const upright = columns && columns.some((label) => width(label) > (0.75 * W) / columns.length - 8);
      let xr = this.range(spec.x, 'x');
      let yr = this.range(spec.y, 'y');
      const right = 14;
      let top = spec.y.k === 'cat' ? 6 : 10;
      let bottom = 42;
      if (upright) bottom = 16 + Math.max(...columns.map((c) => width(c)));
      const label = lines(spec.y.l, 0.6 * W);
      const yTicks = rows ? null : ticks(spec.y, yr, 0.6 * W, 34);
      const widest = rows ? Math.max(...rows.flat().map((l) => width(l))) : Math.max(...yTicks.at.map((t) => width(t[1])), 20);
      const left = Math.ceil(widest) + 12 + (spec.y.l ? 16 * label.length : 0);
      const inner = W - left - right;
      let height;
      if (rows) height = rows.length * Math.max(heat ? 26 : 20, 15 * Math.max(...rows.map((r) => r.length)) + 5);
      else if (spec.q) height = Math.min(inner, 420);
      else height = Math.min(Math.max(0.58 * inner, 130), 260);
      if (spec.q && !this.view) {
        // One unit is as long on both axes: the shorter range is widened about its middle.
        const per = Math.max((xr[1] - xr[0]) / inner, (yr[1] - yr[0]) / height);
        const widen = ([a, b], length) => [(a + b - per * length) / 2, (a + b + per * length) / 2];
        [xr, yr] = [widen(xr, inner), widen(yr, height)];
      }
      const H = top + height + bottom;
      const svg = (this.svg = add(host, 'svg', { class: 'plot', width: W, height: H, viewBox: `0 0 ${W} ${H}`, role: 'img', 'aria-label': [spec.t, spec.y.l, 'against', spec.x.l].filter(Boolean).join(' ') }));
      const id = `clip${Panel.count++}`;
      add(add(svg, 'clipPath', { id }), 'rect', { x: left, y: top, width: inner, height });
      Object.assign(this, { xr, yr, left, top, inner, height });
      this.under = add(svg, 'g', { 'clip-path': `url(#${id})` });
      this.axes(svg, rows, upright, label);
      this.over = add(svg, 'g', { 'clip-path': `url(#${id})` });
      let group = 0;
      const groups = spec.s.filter((l) => l.k === 'bars' || l.k === 'boxes').length;
      for (const layer of spec.s) {
        this.layer(layer, group, groups);
        if (layer.k === 'bars' || layer.k === 'boxes') group++;
      }
      this.marks = add(svg, 'g', { 'clip-path': `url(#${id})` });
      add(svg, 'rect', { x: left, y: top, width: inner, height, style: 'fill:none;stroke:var(--frame);stroke-width:.75' });
      this.pointer(svg);
    }

    place(axis, [lo, hi], v) {
      if (v === null || v === undefined || !isFinite(v)) return null;
      if (axis.k === 'log') return v > 0 ? Math.log(v / lo) / Math.log(hi / lo) : null;
      return (v - lo) / (hi - lo);
    }
    X(v) {
      const f = this.place(this.spec.x, this.xr, v);
      return f === null ? null : this.left + f * this.inner;
    }
    Y(v) {
      const f = this.place(this.spec.y, this.yr, v);
      if (f === null) return null;
      return this.spec.y.k === 'cat' ? this.top + f * this.height : this.top + (1 - f) * this.height;
    }
    value(axis, [lo, hi], f) {
      return axis.k === 'log' ? lo * (hi / lo) ** f : lo + f * (hi - lo);
    }

    axes(svg, rows, upright, label) {
      const { spec, left, top, inner, height } = this;
      const text = (x, y, words, anchor, more = {}) => add(svg, 'text', { x, y, 'text-anchor': anchor, 'font-size': SMALL, ...more }, words);
      const line = (x1, y1, x2, y2) => add(this.under, 'line', { x1, y1, x2, y2, style: 'stroke:var(--grid);stroke-width:1' });
      const roomX = Math.max(46, ...ticks(spec.x, this.xr, inner, 60).at.map((t) => width(t[1]) + 14));
      const x = ticks(spec.x, this.xr, inner, spec.x.k === 'cat' ? 1 : roomX);
      x.at.forEach(([v, words]) => {
        const at = this.X(v);
        if (at === null || at < left - 1 || at > left + inner + 1) return;
        if (spec.x.k !== 'cat') line(at, top, at, top + height);
        if (upright) text(at + 4, top + height + 8, words, 'end', { transform: `rotate(-90 ${at + 4} ${top + height + 8})` });
        else text(at, top + height + 16, words, 'middle');
      });
      const power = (p) => (p ? ` (10${String(p).replace(/./g, (c) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[c] || '⁻')})` : '');
      if (spec.x.l) {
        const all = lines(spec.x.l + power(x.power), inner + left - 8);
        all.forEach((words, i) => {
          const half = width(words) / 2 + 2;
          text(Math.min(Math.max(left + inner / 2, half), this.W - half), top + height + 33 + 14 * i, words, 'middle');
        });
        if (all.length > 1) {
          const H = +svg.getAttribute('height') + 14 * (all.length - 1);
          svg.setAttribute('height', H);
          svg.setAttribute('viewBox', `0 0 ${this.W} ${H}`);
        }
      }
      if (rows) {
        rows.forEach((words, i) => words.forEach((w, k) => text(left - 7, this.Y(i) + 4 + 14 * (k - (words.length - 1) / 2), w, 'end')));
        return;
      }
      const y = ticks(spec.y, this.yr, height, 34);
      y.at.forEach(([v, words]) => {
        const at = this.Y(v);
        if (at === null || at < top - 1 || at > top + height + 1) return;
        line(left, at, left + inner, at);
        text(left - 6, at + 4, words, 'end');
      });
      lines(spec.y.l + power(y.power), height + 30).forEach((words, i) => {
        text(12 + 15 * i, top + height / 2, words, 'middle', { transform: `rotate(-90 ${12 + 15 * i} ${top + height / 2})` });
      });
    }

    path(xs, ys) {
      let d = '';
      let down = false;
      for (let i = 0; i < xs.length; i++) {
        const [x, y] = [this.X(xs[i]), this.Y(ys[i])];
        if (x === null || y === null) down = false;
        else {
          d += `${down ? 'L' : 'M'}${x.toFixed(1)} ${y.toFixed(1)}`;
          down = true;
        }
      }
      return d;
    }

    layer(l, group, groups) {
      const { spec, left, top, inner, height } = this;
      const color = ink(l.c);
      const stroke = `fill:none;stroke:${color};stroke-width:${l.w};stroke-opacity:${l.a};stroke-linejoin:round;stroke-dasharray:${dashes(l)}`;
      const ends = (axis, range, place, [lo, hi]) => [place(lo === null ? range[0] : lo), place(hi === null ? range[1] : hi)];
      const g = this.over;
      const whisker = (x1, y1, x2, y2, style) => {
        if ([x1, y1, x2, y2].includes(null)) return;
        const cap = x1 === x2 ? `M${x1 - 4} ${y1}h8M${x2 - 4} ${y2}h8` : `M${x1} ${y1 - 4}v8M${x2} ${y2 - 4}v8`;
        add(g, 'path', { d: `M${x1} ${y1}L${x2} ${y2}${cap}`, style: `fill:none;stroke:${style};stroke-width:1.4` });
      };
      switch (l.k) {
        case 'line':
          add(g, 'path', { d: this.path(l.p[0], l.p[1]), style: stroke });
          break;
        case 'scatter':
        case 'errors':
          l.p[0].forEach((x, i) => {
            const [a, b] = [this.X(x), this.Y(l.p[1][i])];
            if (a === null || b === null) return;
            if (l.k === 'errors') whisker(a, this.Y(l.p[2][i]), a, this.Y(l.p[3][i]), color);
            marker(g, l.m, a, b, 3.6, color);
          });
          break;
        case 'band': {
          const [xs, lo, hi] = l.p;
          const points = [];
          xs.forEach((x, i) => points.push(`${this.X(x)},${this.Y(lo[i])}`));
          for (let i = xs.length - 1; i >= 0; i--) points.push(`${this.X(xs[i])},${this.Y(hi[i])}`);
          add(g, 'polygon', { points: points.filter((p) => !p.includes('null')).join(' '), style: `fill:${color};fill-opacity:.22` });
          break;
        }
        case 'hspan':
        case 'vspan': {
          const across = l.k === 'vspan';
          const [a, b] = across ? ends(spec.x, this.xr, (v) => this.X(v), l.v) : ends(spec.y, this.yr, (v) => this.Y(v), l.v);
          const rect = across ? { x: Math.min(a, b), y: top, width: Math.abs(b - a), height } : { x: left, y: Math.min(a, b), width: inner, height: Math.abs(b - a) };
          add(this.under, 'rect', { ...rect, style: `fill:${color};fill-opacity:.16` });
          break;
        }
        case 'hline':
          if (this.Y(l.v) !== null) add(g, 'path', { d: `M${left} ${this.Y(l.v)}h${inner}`, style: stroke });
          break;
        case 'vline':
          if (this.X(l.v) !== null) add(g, 'path', { d: `M${this.X(l.v)} ${top}v${height}`, style: stroke });
          break;
        case 'bars': {
          const lying = spec.y.k === 'cat';
          const pitch = 0.78 / Math.max(groups, 1);
          const breadth = (groups > 1 ? 0.9 : 0.7) * pitch;
          const foot = lying ? Math.min(Math.max(0, this.xr[0]), this.xr[1]) : Math.min(Math.max(0, this.yr[0]), this.yr[1]);
          l.p.forEach((v, i) => {
            if (v === null) return;
            const across = i + (group - (groups - 1) / 2) * pitch;
            const corner = (s, w) => (lying ? [this.X(w), this.Y(across + s * breadth)] : [this.X(across + s * breadth), this.Y(w)]);
            const [[x1, y1], [x2, y2]] = [corner(-0.5, foot), corner(0.5, v)];
            add(g, 'rect', { x: Math.min(x1, x2), y: Math.min(y1, y2), width: Math.max(1, Math.abs(x2 - x1)), height: Math.max(1, Math.abs(y2 - y1)), style: `fill:${color};fill-opacity:${0.75 * l.a}` });
            if (l.lo && l.lo[i] !== null && l.hi[i] !== null) whisker(...corner(0, l.lo[i]), ...corner(0, l.hi[i]), 'var(--ink)');
          });
          break;
        }
        case 'hulls':
          l.p.forEach(([x, y, psi]) => {
            const [s, c, a, b] = [Math.sin(psi), Math.cos(psi), l.L / 2, l.B / 2];
            const outline = [[a, 0], [0.7 * a, b], [-a, b], [-a, -b], [0.7 * a, -b]].map(([f, r]) => `${this.X(y + s * f + c * r)},${this.Y(x + c * f - s * r)}`);
            add(g, 'polygon', { points: outline.join(' '), style: `fill:${color};fill-opacity:.15;stroke:${color};stroke-width:1` });
          });
          break;
        case 'arrows':
          l.p.forEach(([x1, y1, x2, y2]) => {
            const [a, b, c, d] = [this.X(x1), this.Y(y1), this.X(x2), this.Y(y2)];
            const size = Math.hypot(c - a, d - b);
            if (!(size > 0.5)) return;
            const [ux, uy, h] = [(c - a) / size, (d - b) / size, Math.min(6, 0.45 * size)];
            const head = `M${c} ${d}L${c - h * ux - 0.5 * h * uy} ${d - h * uy + 0.5 * h * ux}M${c} ${d}L${c - h * ux + 0.5 * h * uy} ${d - h * uy - 0.5 * h * ux}`;
            add(g, 'path', { d: `M${a} ${b}L${c} ${d}${head}`, style: stroke });
          });
          break;
        case 'heat': {
          const cell = inner / spec.x.c.length;
          l.p.forEach((row, i) =>
            row.forEach((v, j) => {
              if (v === null) return;
              const [x, y, h] = [this.X(j), this.Y(i), height / l.p.length];
              add(g, 'rect', { x: x - cell / 2, y: y - h / 2, width: cell, height: h, style: `fill:${l.f[i][j]}` });
              if (cell > 34) add(g, 'text', { x, y: y + 4, 'text-anchor': 'middle', 'font-size': SMALL, style: `fill:${l.b[i][j] ? '#fff' : '#111'}` }, l.t[i][j]);
            })
          );
          break;
        }
        case 'text': {
          const x = this.X(l.v[0]);
          const side = (x - left) / inner;
          add(g, 'text', { x: x + (side < 0.33 ? 5 : side > 0.67 ? -5 : 0), y: this.Y(l.v[1]) + 4, 'text-anchor': side < 0.33 ? 'start' : side > 0.67 ? 'end' : 'middle', 'font-size': SMALL, style: `fill:${color}` }, l.n);
          break;
        }
      }
    }

    // Points of the layers that a pointer can be near to: layer, index, place, words.
    points() {
      const out = [];
      const name = (axis, v) => (axis.k === 'cat' ? axis.c[Math.round(v)] : number(v));
      for (const l of this.spec.s) {
        if (['line', 'scatter', 'errors'].includes(l.k) && (l.n || l.k !== 'line')) {
          l.p[0].forEach((x, i) => {
            const interval = l.k === 'errors' && l.p[2][i] !== null ? ` (${number(l.p[2][i])} to ${number(l.p[3][i])})` : '';
            out.push({ l, i, x: this.X(x), y: this.Y(l.p[1][i]), words: `${l.n}: ${name(this.spec.x, x)}, ${name(this.spec.y, l.p[1][i])}${interval}` });
          });
        } else if (l.k === 'bars') {
          const lying = this.spec.y.k === 'cat';
          l.p.forEach((v, i) => {
            const interval = l.lo && l.lo[i] !== null ? ` (${number(l.lo[i])} to ${number(l.hi[i])})` : '';
            out.push({ l, i, x: lying ? this.X(v) : this.X(i), y: lying ? this.Y(i) : this.Y(v), words: `${(lying ? this.spec.y : this.spec.x).c[i]}: ${number(v)}${interval}` });
          });
        } else if (l.k === 'heat') {
          l.p.forEach((row, i) => row.forEach((v, j) => v !== null && out.push({ l, i, x: this.X(j), y: this.Y(i), words: `${this.spec.y.c[i]}, ${this.spec.x.c[j]}: ${number(v)}` })));
        }
      }
      return out.filter((p) => p.x !== null && p.y !== null);
    }

    hover(event, [px, py]) {
      this.marks.replaceChildren();
      const all = this.points();
      if (!all.length) return;
      const byTime = this.spec.x.k === 'lin' && !this.spec.q && this.spec.s.some((l) => l.k === 'line' && l.p[0].length > 7);
      const far = (p) => (byTime ? Math.abs(p.x - px) * 1e3 + Math.abs(p.y - py) : Math.hypot(p.x - px, p.y - py));
      const nearest = all.reduce((a, b) => (far(b) < far(a) ? b : a));
      if (byTime) {
        const same = all.filter((p) => p.l.k === 'line' && Math.abs(p.x - nearest.x) < 0.6);
        const once = same.filter((p, i) => same.findIndex((q) => q.l.n === p.l.n) === i);
        if (!once.length) once.push(nearest);
        add(this.marks, 'path', { d: `M${nearest.x} ${this.top}v${this.height}`, style: 'stroke:var(--frame);stroke-dasharray:3 3' });
        once.forEach((p) => add(this.marks, 'circle', { cx: p.x, cy: p.y, r: 4, style: `fill:${ink(p.l.c)}` }));
        const at = this.value(this.spec.x, this.xr, (nearest.x - this.left) / this.inner);
        showTip(event, [`${this.spec.x.l}: ${number(at)}`, ...once.map((p) => `${p.l.n}: ${number(p.l.p[1][p.i])}`)]);
      } else {
        if (Math.hypot(nearest.x - px, nearest.y - py) > 40 && nearest.l.k !== 'heat') {
          tip.hidden = true;
          return;
        }
        add(this.marks, 'circle', { cx: nearest.x, cy: nearest.y, r: 6, style: 'fill:none;stroke:var(--ink);stroke-width:1.5' });
        showTip(event, [nearest.words]);
      }
      if (this.figure.linked) this.figure.panels.forEach((p) => p !== this && p.mark(nearest.i));
    }

    // Marks sample `i` of every series: the same instant as in the panel that the pointer is over.
    mark(i) {
      this.marks.replaceChildren();
      for (const l of this.spec.s) {
        if (l.k !== 'line' || l.p[0].length <= i || !l.n) continue;
        const [x, y] = [this.X(l.p[0][i]), this.Y(l.p[1][i])];
        if (x !== null && y !== null) add(this.marks, 'circle', { cx: x, cy: y, r: 4, style: `fill:${ink(l.c)}` });
      }
    }

    pointer(svg) {
      const at = (event) => {
        const box = svg.getBoundingClientRect();
        const k = this.W / box.width;
        return [(event.clientX - box.left) * k, (event.clientY - box.top) * k];
      };
      let from = null;
      let frame = null;
      const inside = ([x, y]) => [Math.min(Math.max(x, this.left), this.left + this.inner), Math.min(Math.max(y, this.top), this.top + this.height)];
      svg.addEventListener('pointerdown', (event) => {
        const p = at(event);
        if (p[0] < this.left || p[1] > this.top + this.height) return;
        from = inside(p);
        this.hover(event, p);
      });
      svg.addEventListener('pointermove', (event) => {
        const p = at(event);
        if (!from) return this.hover(event, p);
        const to = inside(p);
        if (Math.hypot(to[0] - from[0], to[1] - from[1]) < 8) return;
        tip.hidden = true;
        if (!frame) {
          frame = add(svg, 'rect', { style: 'fill:var(--link);fill-opacity:.15;stroke:var(--link)' });
          svg.setPointerCapture(event.pointerId);
        }
        const [x, y] = this.zoomed(from, to);
        const rect = { x: x[0], y: y[0], width: x[1] - x[0], height: y[1] - y[0] };
        for (const key in rect) frame.setAttribute(key, rect[key]);
      });
      const end = (event) => {
        const [start, to] = [from, inside(at(event))];
        from = null;
        if (!frame) return;
        frame = null;
        if (event.type !== 'pointerup') return this.draw(this.W);
        const [x, y] = this.zoomed(start, to);
        const part = (axis, range, [a, b], corner, length, flip) => {
          if (axis.k === 'cat') return range;
          const f = [(a - corner) / length, (b - corner) / length];
          return (flip ? [1 - f[1], 1 - f[0]] : f).map((v) => this.value(axis, range, v));
        };
        this.view = { x: part(this.spec.x, this.xr, x, this.left, this.inner, false), y: part(this.spec.y, this.yr, y, this.top, this.height, true) };
        this.draw(this.W);
        this.figure.reset.hidden = false;
      };
      svg.addEventListener('pointerup', end);
      svg.addEventListener('pointercancel', end);
      svg.addEventListener('pointerleave', () => {
        tip.hidden = true;
        this.figure.panels.forEach((p) => p.marks.replaceChildren());
      });
      svg.addEventListener('dblclick', () => this.figure.whole());
    }

    // The part of the plot that a pointer has drawn a frame around, in px: of both axes, or of one where the other was hardly left.
    zoomed(a, b) {
      let x = [Math.min(a[0], b[0]), Math.max(a[0], b[0])];
      let y = [Math.min(a[1], b[1]), Math.max(a[1], b[1])];
      if (!this.spec.q && y[1] - y[0] < 20) y = [this.top, this.top + this.height];
      if (!this.spec.q && x[1] - x[0] < 20) x = [this.left, this.left + this.inner];
      if (this.spec.q) {
        // Tracks keep their shape.
        const k = Math.max((x[1] - x[0]) / this.inner, (y[1] - y[0]) / this.height, 0.02);
        const about = ([p, q], length) => [(p + q - k * length) / 2, (p + q + k * length) / 2];
        [x, y] = [about(x, this.inner), about(y, this.height)];
      }
      return [x, y];
    }
  }
  Panel.count = 0;

  // A figure: controls, legend and panels in a container.
  class Figure {
    constructor(host, spec, linked = false) {
      Object.assign(this, { host, spec, linked, panels: [] });
      host.replaceChildren();
      this.controls = html(host, 'div', 'controls');
      this.reset = html(this.controls, 'button', '', 'Show all again');
      this.reset.type = 'button';
      this.reset.hidden = true;
      this.reset.addEventListener('click', () => this.whole());
      this.legend = html(host, 'div', 'legend');
      this.grid = html(host, 'div', 'panels');
      this.show(spec);
    }

    show(spec) {
      this.spec = spec;
      this.legend.replaceChildren();
      const named = new Set();
      for (const l of spec.panels.flatMap((p) => p.s)) {
        if (!l.g || !l.n || named.has(l.n) || spec.legend === false) continue;
        named.add(l.n);
        const entry = html(this.legend, 'span');
        const svg = add(entry, 'svg', { width: 26, height: 14, viewBox: '0 0 26 14', 'aria-hidden': 'true' });
        const style = `fill:none;stroke:${ink(l.c)};stroke-width:${Math.min(l.w, 3)};stroke-dasharray:${dashes(l)}`;
        if (['line', 'hline', 'vline', 'arrows'].includes(l.k)) add(svg, 'path', { d: 'M0 7h26', style });
        else if (['scatter', 'errors'].includes(l.k)) marker(svg, l.m, 13, 7, 4, ink(l.c));
        else add(svg, 'rect', { x: 2, y: 1, width: 22, height: 12, style: `fill:${ink(l.c)};fill-opacity:${l.k === 'bars' ? 0.75 : 0.25}` });
        html(entry, 'span', '', l.n);
      }
      this.grid.replaceChildren();
      this.panels = spec.panels.map((p) => new Panel(this, p, html(this.grid, 'div')));
      this.whole();
    }

    whole() {
      this.panels.forEach((p) => (p.view = null));
      this.reset.hidden = true;
      this.fit();
    }

    fit(given) {
      const all = given || this.host.clientWidth;
      const wide = this.spec.panels.some((p) => p.y.k === 'cat' || p.x.k === 'cat');
      // As many as fit, so that rows of the figure stay together where they can.
      let columns = Math.max(1, Math.min(this.spec.columns, Math.floor((all + 18) / (given ? (wide ? 320 : 215) : wide ? 440 : 280))));
      if (columns > 2 && this.spec.columns % columns) columns = 2;
      this.grid.style.gridTemplateColumns = `repeat(${columns}, minmax(0, 1fr))`;
      const each = Math.floor((all - 19.2 * (columns - 1)) / columns);
      this.panels.forEach((p) => {
        // The panel to be seen first takes four places where there is room.
        const large = p.spec.large && columns > 2;
        p.host.style.gridArea = large ? 'span 2 / span 2' : '';
        p.draw(large ? 2 * each + 19 : Math.min(each, wide ? 760 : 620));
      });
    }
  }

  // The picture of one run: track, and motion over time, as recorded and as simulated.
  const DEGREES = 180 / Math.PI;
  const runFigure = (run) => {
    const series = data.runs.series.map((s, k) => ({ ...s, z: run.z[k] })).filter((s) => s.z);
    const line = (s, xs, ys) => ({ k: 'line', n: s.name, c: s.color, a: 1, d: s.dash, w: s.width, g: true, p: [xs, ys] });
    const range = (values, pad) => {
      const known = values.flat().filter((v) => v !== null);
      if (!known.length) return [0, 1];
      let [lo, hi] = [Math.min(...known), Math.max(...known)];
      if (hi - lo < 1e-9) [lo, hi] = [lo - 1, hi + 1];
      return [lo - pad * (hi - lo), hi + pad * (hi - lo)];
    };
    const scaled = (values, k) => values.map((v) => (v === null ? null : v * k));
    const axis = (l, r, e) => ({ l, k: 'lin', r, e });
    // Room for the whole outline wherever a ship is: half a length about each of its positions.
    const about = (values) => values.flatMap((v) => (v === null ? [] : [v - data.runs.length / 2, v + data.runs.length / 2]));
    // Headings of a long log are unwrapped: whole turns before this run say nothing of it.
    const first = series[0].z[2].find((v) => v !== null) || 0;
    const turns = Math.floor(first / (2 * Math.PI)) * 360;
    const track = {
      t: run.name, q: true, large: true,
      x: axis('east y [m]', range(series.map((s) => about(s.z[1])), 0.03)),
      y: axis('north x [m]', range(series.map((s) => about(s.z[0])), 0.03)),
      s: [
        ...series.map((s) => line(s, s.z[1], s.z[0])),
        ...series.map((s) => {
          const stride = Math.max(1, Math.floor(s.z[0].length / 6));
          const poses = s.z[0].map((x, i) => [x, s.z[1][i], s.z[2][i]]).filter((p, i) => i % stride === 0 && !p.includes(null));
          return { k: 'hulls', n: s.name, c: s.color, a: 1, w: 1, g: false, L: data.runs.length, B: data.runs.breadth, p: poses };
        }),
      ],
    };
    const over = (label, of, angle) => {
      const drawn = of();
      return { t: '', q: false, x: axis('time [s]', range([run.t], 0.02)), y: { ...axis(label, range(drawn.map((l) => l.p[1]), 0.06)), g: angle }, s: drawn };
    };
    const state = (c, k) => () => series.map((s) => line(s, run.t, scaled(s.z[c], k)));
    const heading = () => series.map((s) => line(s, run.t, s.z[2].map((v) => (v === null ? null : v * DEGREES - turns))));
    const recorded = series[0].z;
    const apart = () =>
      series.slice(1).map((s) => line(s, run.t, s.z[0].map((x, i) => (x === null || recorded[0][i] === null || recorded[1][i] === null ? null : Math.hypot(x - recorded[0][i], s.z[1][i] - recorded[1][i])))));
    const order = (label, values, k) => () => [{ k: 'line', n: label, c: '#787878', a: 1, d: 0, w: 1.6, g: false, p: [run.t, scaled(values, k)] }];
    return {
      columns: 3,
      panels: [
        track,
        over('position error [m]', apart),
        over('heading psi [deg]', heading, true),
        over('surge velocity u [m/s]', state(3, 1)),
        over('sway velocity v [m/s]', state(4, 1)),
        over('yaw rate r [deg/s]', state(5, DEGREES)),
        over('propeller rate n [1/s]', order('propeller rate', run.n, 1)),
        over('rudder angle delta [deg]', order('rudder angle', run.d, DEGREES)),
      ],
    };
  };

  const figures = [];
  const host = document.getElementById('run-picture');
  if (host && data.runs && data.runs.runs.length) {
    const runs = data.runs.runs;
    const figure = new Figure(host, runFigure(runs[data.runs.first]), true);
    figures.push(figure);
    const choice = html(figure.controls, 'label', '', 'Run ');
    const select = html(choice, 'select');
    runs.forEach((run, i) => {
      const option = html(select, 'option', '', run.name);
      option.value = i;
      option.selected = i === data.runs.first;
    });
    const note = html(figure.controls, 'span', '', runs[data.runs.first].note);
    select.addEventListener('change', () => {
      figure.show(runFigure(runs[+select.value]));
      note.textContent = runs[+select.value].note;
    });
  }
  for (const place of document.querySelectorAll('[data-figure]')) {
    const spec = data.figures[place.dataset.figure];
    if (!spec) continue;
    try {
      figures.push(new Figure(place, spec));
    } catch (error) {
      // The others are drawn all the same; the console has the error.
      setTimeout(() => {
        throw error;
      });
    }
  }
  let last = document.documentElement.clientWidth;
  addEventListener('resize', () => {
    const now = document.documentElement.clientWidth;
    if (now !== last) figures.forEach((f) => f.fit());
    last = now;
  });
  addEventListener('beforeprint', () => {
    document.querySelectorAll('details').forEach((d) => (d.open = true));
    figures.forEach((f) => f.fit(675));
  });
  addEventListener('afterprint', () => figures.forEach((f) => f.fit()));
})();
