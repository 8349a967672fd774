// Controls and labels of the scene of a run. scene.js makes use of them.
const sceneControls = (() => {
  'use strict';

  const GROUPS = { bodies: 'Bodies', contact: 'Contact surfaces' };

  function number(value, significant = 4) {
    return String(Number(value.toPrecision(significant))).replace('-', '\u2212');
  }

  function parts(label) {
    const [, name, unit] = label.match(/^(.*?)(?:\s*\(([^()]*)\))?$/);
    return { name, unit: unit ? ` ${unit}` : '' };
  }

  function element(name, properties = {}, ...children) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  }

  const labelled = (text, ...controls) => element('label', {}, element('span', { textContent: text }), ...controls);

  function choice(text, options, value, change) {
    const select = element('select', { onchange: () => change(select.value) });
    const option = ([key, shown]) => element('option', { value: key, textContent: shown });
    select.append(...Object.entries(options).map(option));
    select.value = value;
    return labelled(text, select);
  }

  function tick(text, change) {
    const box = element('input', { type: 'checkbox', onchange: () => change(box.checked) });
    return Object.assign(element('label', { className: 'tick' }, box, text), { box });
  }

  function slider(name, text, last, change) {
    const range = element('input', { type: 'range', min: 0, max: last, step: 1, value: 0, className: name });
    range.oninput = () => change(Number(range.value));
    return Object.assign(labelled(text, range, element('output')), { range });
  }

  // The steps of a scale from zero: about `count`, round numbers.
  function roundStep(top, count) {
    const rough = top / count;
    const power = 10 ** Math.floor(Math.log10(rough));
    return power * [1, 2, 5, 10].find(step => step * power >= rough * 0.999);
  }

  function colourBar(group, field, colours) {
    const title = element('div', { textContent: `${GROUPS[group]}: ${field.label}` });
    const bar = element('div', { className: 'bar' }, title);
    const strip = bar.appendChild(element('div', { className: 'strip' }));
    strip.style.background = `linear-gradient(to right,${colours.split(' ').join()})`;
    const top = field.top > 0 ? field.top : 1;
    const step = roundStep(top, 5);
    for (let k = 0; k * step <= top * 1.001; k++) {
      const mark = strip.appendChild(element('span', { textContent: number(k * step) }));
      mark.style.left = `${100 * k * step / top}%`;
    }
    return bar;
  }

  // Lines and a text over the picture: where the axes point, and a length at the middle of the view.
  class Overlay {
    constructor(stage) {
      const made = (name, parent, attributes) => {
        const shape = document.createElementNS('http://www.w3.org/2000/svg', name);
        Object.entries(attributes).forEach(([key, value]) => shape.setAttribute(key, value));
        return parent.appendChild(shape);
      };
      this.svg = made('svg', stage, { class: 'over', 'aria-hidden': 'true' });
      this.axes = ['x', 'y', 'z'].map(name => {
        const [line, text] = [made('line', this.svg, {}), made('text', this.svg, {})];
        text.textContent = name === 'x' ? 'x, rolling' : name;
        return { line, text };
      });
      this.length = made('path', this.svg, {});
      this.lengthText = made('text', this.svg, {});
      this.dot = made('circle', this.svg, { r: 4, class: 'dot' });
    }

    draw(camera, target, { width, height }, point) {
      this.axes.forEach(({ line, text }, k) => {
        const to = new THREE.Vector3().setComponent(k, 30).applyQuaternion(camera.quaternion.clone().invert());
        const [x, y] = [48, height - 44];
        const ends = { x1: x, y1: y, x2: x + to.x, y2: y - to.y };
        Object.entries(ends).forEach(([key, value]) => line.setAttribute(key, value));
        text.setAttribute('x', x + 1.25 * to.x - 3);
        text.setAttribute('y', y - 1.25 * to.y + 4);
      });
      const pixels = height / (2 * camera.position.distanceTo(target) * Math.tan(camera.fov * Math.PI / 360));
      const length = roundStep(width / pixels, 7);
      const [right, base] = [width - 16, height - 16];
      this.length.setAttribute('d', `M${right - length * pixels} ${base - 6}v6H${right}v-6`);
      this.lengthText.textContent = `${number(1000 * length)} mm`;
      this.lengthText.setAttribute('x', right - 4 - this.lengthText.getComputedTextLength());
      this.lengthText.setAttribute('y', base - 6);
      const on = point?.clone().project(camera);
      this.dot.setAttribute('cx', on ? (on.x + 1) / 2 * width : -9);
      this.dot.setAttribute('cy', on ? (1 - on.y) / 2 * height : -9);
    }
  }

  return { GROUPS, number, parts, element, choice, tick, slider, colourBar, Overlay };
})();
