// Values under the pointer: of lines those at its x, of dots the nearest, of a map that of the cell. They are read from
// what is drawn, with the digits that pixels and colours give them. crates/creepage/src/chart/group.rs says which attributes
// figures have.

// An axis, or the scale of a map's colours: its ends are logarithms to base 10 where it is logarithmic.
function axis(text) {
  const [scale, low, high] = text.split(' ');
  return { log: scale === 'log', low: Number(low), high: Number(high) };
}

function valueAt({ log, low, high }, share) {
  const place = low + share * (high - low);
  return log ? 10 ** place : place;
}

// A value of an axis on which so many steps can be told apart, with no more digits than that.
function digits({ log, low, high }, steps, value) {
  if (value === 0) return '0';
  const step = log ? value * Math.LN10 * (high - low) / steps : Math.abs(high - low) / steps;
  const last = Math.round(Math.log10(step));
  const first = Math.floor(Math.log10(Math.abs(value)));
  if (first < last) return '0';
  const significant = Math.min(first - last + 1, 6);
  const short = first >= -3 && first < 5;
  const text = short ? Number(value.toPrecision(significant)).toFixed(Math.max(-last, 0))
    : value.toExponential(significant - 1).replace(/e\+?(.*)/, ' × 10^{$1}');
  return text.replaceAll('-', '\u2212');
}

// A label in parts: what it names, and its unit.
function parts(label) {
  const [, name, unit] = label.match(/^(.*?)(?:\s*\(([^()]*)\))?$/);
  return { name, unit: unit === undefined || unit === '-' ? '' : ` ${unit.replace(/^10/, '\u00b7 10')}` };
}

// The height of a line at x, nearest to y where it has several; none where it has none. The line is a list of pieces,
// each a list of points; pieces that are no farther apart than a gap between dashes are joined.
function heightAt(pieces, gap, [x, y]) {
  let found = null;
  const bridge = ([[px, py], [qx, qy]]) => {
    if (Math.min(px, qx) > x || Math.max(px, qx) < x) return;
    const height = px === qx ? Math.min(Math.max(y, Math.min(py, qy)), Math.max(py, qy))
      : py + (x - px) / (qx - px) * (qy - py);
    if (found === null || Math.abs(height - y) < Math.abs(found - y)) found = height;
  };
  pieces.forEach((piece, i) => {
    for (let k = 1; k < piece.length; k++) bridge([piece[k - 1], piece[k]]);
    const [end, next] = [piece.at(-1), pieces[i + 1]?.[0]];
    if (next && Math.hypot(next[0] - end[0], next[1] - end[1]) <= 1.5 * gap) bridge([end, next]);
  });
  return found;
}

// Where a colour is between evenly spaced ones, 0 to 1.
function shareOf(colour, colours) {
  const rgb = hex => [1, 3, 5].map(at => parseInt(hex.slice(at, at + 2), 16));
  const [at, stops] = [rgb(colour), colours.map(rgb)];
  let best = { miss: Infinity, share: 0 };
  for (let k = 1; k < stops.length; k++) {
    const along = stops[k].map((value, c) => value - stops[k - 1][c]);
    const from = at.map((value, c) => value - stops[k - 1][c]);
    const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const part = Math.min(Math.max(dot(from, along) / dot(along, along), 0), 1);
    const miss = Math.hypot(...from.map((value, c) => value - part * along[c]));
    if (miss < best.miss) best = { miss, share: (k - 1 + part) / (stops.length - 1) };
  }
  return best.share;
}

// What a cell of a map shows.
function cellValue(map, colour) {
  const colours = map.colours.split(' ');
  if (map.map === 'classes') return map.names.split(';')[colours.indexOf(colour)] ?? '';
  const [scale, share] = [axis(map.map), shareOf(colour, colours)];
  // values beyond the ends have the colours of the ends
  const relation = { 0: '\u2264', 1: '\u2265' }[share] ?? '=';
  const { name, unit } = parts(map.label);
  return `${name} ${relation} ${digits(scale, 250, valueAt(scale, share))}${unit}`;
}

if (typeof document !== 'undefined') {
  const shown = document.body.appendChild(document.createElement('div'));
  shown.id = 'values';
  shown.hidden = true;
  const rule = document.createElementNS('http://www.w3.org/2000/svg', 'line');
  rule.id = 'rule';
  const pieces = new WeakMap();

  const piecesOf = line => {
    if (!pieces.has(line)) {
      const points = element => element.getAttribute('points').trim().split(/\s+/);
      pieces.set(line, [...line.children].filter(child => child.localName === 'polyline')
        .map(child => points(child).map(point => point.split(',').map(Number))));
    }
    return pieces.get(line);
  };

  // A row of text, with subscripts and powers as such, after a sample of its colour.
  const row = (text, colour) => {
    const line = shown.appendChild(document.createElement('div'));
    if (colour) line.appendChild(document.createElement('i')).style.background = colour;
    text.split(/([_^]\{[^}]*\})/).forEach(part => {
      const kind = { '_': 'sub', '^': 'sup' }[part[0]];
      if (kind && part[1] === '{') {
        line.appendChild(document.createElement(kind)).textContent = part.slice(2, -1);
      } else line.append(part);
    });
  };

  const hide = () => { shown.hidden = true; rule.remove(); };

  const show = event => {
    const svg = event.target.closest?.('figure svg');
    if (!svg) return hide();
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    const box = plot => plot.dataset.box.split(' ').map(Number);
    const inside = plot => {
      const [left, top, right, bottom] = box(plot);
      return at.x >= left && at.x <= right && at.y >= top && at.y <= bottom;
    };
    const plot = [...svg.querySelectorAll('[data-box]')].find(inside);
    if (!plot) return hide();
    const [left, top, right, bottom] = box(plot);
    const [across, up] = [axis(plot.dataset.x), axis(plot.dataset.y)];
    const x = px => digits(across, right - left, valueAt(across, (px - left) / (right - left)));
    const y = px => digits(up, bottom - top, valueAt(up, (bottom - px) / (bottom - top)));
    const [along, upwards] = [parts(plot.dataset.xLabel), parts(plot.dataset.yLabel)];
    shown.replaceChildren();
    rule.remove();
    row(`${along.name} = ${x(at.x)}${along.unit}`);
    if (plot.querySelector('[data-map]')) {
      row(`${upwards.name} = ${y(at.y)}${upwards.unit}`);
      const cell = document.elementsFromPoint(event.clientX, event.clientY)
        .find(element => plot.contains(element) && element.parentNode.dataset.map);
      const colour = cell?.getAttribute('fill');
      if (cell) row(cellValue(cell.parentNode.dataset, colour), colour);
    } else {
      const of = (name, text) => name ? `${name}: ${text}` : text;
      const all = [...plot.querySelectorAll('[data-line],[data-dots]')];
      const named = all.filter(series => series.dataset.line || series.dataset.dots);
      for (const series of named.length ? named : all) {
        if (series.dataset.dots === undefined) {
          const height = heightAt(piecesOf(series), Number(series.dataset.gap ?? 0), [at.x, at.y]);
          const colour = series.firstElementChild?.getAttribute('stroke');
          if (height !== null) row(of(series.dataset.line, y(height) + upwards.unit), colour);
        } else {
          const centre = dot => [Number(dot.getAttribute('cx')), Number(dot.getAttribute('cy'))];
          const far = ([cx, cy]) => Math.hypot(cx - at.x, cy - at.y);
          const dots = [...series.children].map(centre).filter(dot => far(dot) < 40);
          const nearest = dots.sort((a, b) => far(a) - far(b))[0];
          const colour = series.firstElementChild?.getAttribute('fill');
          if (nearest) {
            const place = `${x(nearest[0])}${along.unit}, ${y(nearest[1])}${upwards.unit}`;
            row(of(series.dataset.dots, place), colour);
          }
        }
      }
      Object.entries({ x1: at.x, x2: at.x, y1: top, y2: bottom }).forEach(([name, value]) => rule.setAttribute(name, value));
      svg.append(rule);
    }
    shown.hidden = false;
    const { width, height } = shown.getBoundingClientRect();
    const beside = event.clientX + 16;
    shown.style.left = `${beside + width > innerWidth ? Math.max(event.clientX - 16 - width, 0) : beside}px`;
    shown.style.top = `${Math.min(event.clientY + 16, Math.max(innerHeight - height, 0))}px`;
  };

  document.addEventListener('pointermove', show);
  document.addEventListener('pointerdown', show);
  document.addEventListener('scroll', hide, { passive: true });
  document.documentElement.addEventListener('pointerleave', hide);
}
