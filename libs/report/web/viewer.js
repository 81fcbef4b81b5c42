// SPDX-License-Identifier: BSD-3-Clause
// The map in three dimensions: the controls of viewer.html say what scene.js draws.
'use strict';
(() => {
  const {VoxelModel, Scene} = window.csom;
  const CLICK_PIXELS = 5;
  // Viridis, the colour map that also people with colour-blind eyes can read.
  const RAMP = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141],
    [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];

  const format = (value, digits = 3) => {
    if (value !== 0 && Math.abs(value) < 1e-3) return value.toExponential(1);
    return Number(value.toPrecision(digits)).toLocaleString('en');
  };
  const count = (number) => number.toLocaleString('en');

  /** Reads the controls of the page and writes what the picture shows. */
  class Panel {
    constructor(section, header, model) {
      this.section = section;
      this.header = header;
      this.model = model;
      this.scene = new Scene(this.find('canvas'), model);
      this.scene.addTrajectories(header.trajectories);
      this.shown = [];
      this.addClasses();
      this.addSlice();
      this.addButtons();
      this.addPicking();
      this.find('#viewer-color').addEventListener('change', () => this.color());
      this.find('#viewer-trajectory').addEventListener('change', (event) => {
        this.scene.path.visible = event.target.checked;
        this.scene.request();
      });
      if (header.trajectories.length === 0) this.find('.trajectory').hidden = true;
      this.scene.onDrawn = () => this.tellCount();
      this.color();
      this.show();
    }

    find(selector) {
      return this.section.querySelector(selector);
    }

    addClasses() {
      const list = this.find('.classes ul');
      for (const {id, name, voxels, shown} of this.header.classes) {
        this.shown[id] = shown;
        const box = document.createElement('input');
        box.type = 'checkbox';
        box.checked = shown;
        box.dataset.class = id;
        box.addEventListener('change', () => {
          this.shown[id] = box.checked;
          this.show();
        });
        list.append(this.classLine(box, id, name, count(voxels)));
      }
      for (const button of this.section.querySelectorAll('[data-classes]')) {
        button.addEventListener('click', () => {
          for (const box of list.querySelectorAll('input')) {
            box.checked = button.dataset.classes === 'all';
            this.shown[box.dataset.class] = box.checked;
          }
          this.show();
        });
      }
    }

    classLine(box, id, name, voxels) {
      const line = document.createElement('li');
      const label = document.createElement('label');
      const number = document.createElement('span');
      number.className = 'number';
      number.textContent = voxels;
      label.append(box, this.swatch(id), name);
      line.append(label, number);
      return line;
    }

    swatch(id) {
      const swatch = document.createElement('span');
      swatch.className = 'swatch';
      swatch.dataset.class = id;
      swatch.style.background = `rgb(${this.colorOf(id).join()})`;
      return swatch;
    }

    /** As chosen; also beside what is coloured by something else. */
    colorOf(id) {
      const {color, safeColor} = this.header.classNames[id];
      return this.safe ? safeColor : color;
    }

    /** Height of a layer's lower face [m]. */
    heightOf(layer) {
      return layer * this.header.resolution;
    }

    addSlice() {
      const {low, high} = this.header.layers;
      for (const id of ['lowest', 'highest']) {
        const slider = this.find(`#viewer-${id}`);
        Object.assign(slider, {min: low, max: high, step: 1});
        slider.value = id === 'lowest' ? low : high;
        slider.addEventListener('input', () => {
          // Each pushes the other along.
          const other = this.find(`#viewer-${id === 'lowest' ? 'highest' : 'lowest'}`);
          const crossed = id === 'lowest' ? +slider.value > +other.value :
            +slider.value < +other.value;
          if (crossed) other.value = slider.value;
          this.tellSlice();
          this.showSoon();
        });
      }
    }

    addButtons() {
      for (const button of this.section.querySelectorAll('[data-view]')) {
        button.addEventListener('click', () => {
          if (button.dataset.view !== 'full') return this.scene.lookFrom(button.dataset.view);
          if (document.fullscreenElement) return document.exitFullscreen();
          return this.section.requestFullscreen();
        });
      }
      const full = this.find('[data-view="full"]');
      full.hidden = !document.fullscreenEnabled;
      document.addEventListener('fullscreenchange', () =>
        full.setAttribute('aria-pressed', String(document.fullscreenElement !== null)));
    }

    addPicking() {
      const canvas = this.find('canvas');
      let down;
      canvas.addEventListener('pointerdown', (event) => { down = event; });
      canvas.addEventListener('pointerup', (event) => {
        const moved = down ? Math.hypot(event.x - down.x, event.y - down.y) : Infinity;
        down = undefined;
        if (moved > CLICK_PIXELS || event.button !== 0) return;
        this.choose(this.scene.pick(event.offsetX, event.offsetY));
      });
      canvas.addEventListener('keydown', (event) => this.press(event));
      this.find('.voxel .close').addEventListener('click', () => this.choose(undefined));
    }

    press(event) {
      if (event.ctrlKey || event.altKey || event.metaKey) return;
      const canvas = event.target;
      const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
      const arrow = arrows[event.key];
      if (arrow && event.shiftKey) this.scene.move(0.05 * arrow[0], 0.05 * arrow[1]);
      else if (arrow) this.scene.turn(0.1 * arrow[0], -0.1 * arrow[1]);
      else if (event.key === '+' || event.key === '=') this.scene.zoom(0.85);
      else if (event.key === '-') this.scene.zoom(1 / 0.85);
      else if (event.key === '0') this.scene.lookFrom('oblique');
      else if (event.key === 'Enter')
        this.choose(this.scene.pick(canvas.clientWidth / 2, canvas.clientHeight / 2));
      else if (event.key === 'Escape') this.choose(undefined);
      else return;
      event.preventDefault();
    }

    /** At the next picture: a slider tells more positions than can be drawn. */
    showSoon() {
      if (this.showing) return;
      this.showing = true;
      requestAnimationFrame(() => {
        this.showing = false;
        this.show();
      });
      this.scene.request();
    }

    /** The layers that the sliders let through. */
    slice() {
      return ['lowest', 'highest'].map((id) => Number(this.find(`#viewer-${id}`).value));
    }

    tellSlice() {
      const [low, high] = this.slice();
      const tell = (id, layer) => {
        const text = `${format(this.heightOf(layer))} m`;
        this.find(`output[for=viewer-${id}]`).textContent = text;
        this.find(`#viewer-${id}`).setAttribute('aria-valuetext', text);
      };
      tell('lowest', low);
      tell('highest', high + 1);
    }

    show() {
      const [low, high] = this.slice();
      const {sign} = this.header.up;
      const index = (l) => sign > 0 ? l : -l - 1;
      this.scene.renew(this.model.show(
          this.shown, Math.min(index(low), index(high)), Math.max(index(low), index(high))));
      this.tellSlice();
      this.tellCount();
    }

    tellCount() {
      const size = this.header.voxelsPerCube;
      const what = size > 1 ? `cubes of ${size}×${size}×${size} voxels` : 'occupied voxels';
      const detail = 2 ** (this.scene.coarsest || 0);
      const coarse = detail > 1 ? ` Far ones are drawn up to ${detail}×${detail}×${detail} at a ` +
          'time; come nearer for all of them.' : '';
      const text = `You are looking at ${count(this.model.visibleCount)} of ` +
          `${count(this.header.voxels)} ${what}.${coarse}`;
      const line = this.find('.count');
      if (line.textContent !== text) line.textContent = text;
    }

    color() {
      const mode = this.find('#viewer-color').value;
      const bytes = new Uint8Array(256 * 4);
      const scale = this.find('.scale');
      const byClass = mode.startsWith('class');
      scale.hidden = byClass;
      if (byClass) {
        this.safe = mode === 'class-safe';
        for (const {id} of this.header.classes) bytes.set([...this.colorOf(id), 255], 4 * id);
        for (const swatch of this.section.querySelectorAll('.swatch[data-class]')) {
          swatch.style.background = `rgb(${this.colorOf(swatch.dataset.class).join()})`;
        }
      } else {
        for (let i = 0; i < 256; ++i) {
          const at = i / 255 * (RAMP.length - 1);
          const from = Math.min(Math.floor(at), RAMP.length - 2);
          const mixed = RAMP[from].map((c, k) => c + (RAMP[from + 1][k] - c) * (at - from));
          bytes.set([...mixed, 255], 4 * i);
        }
        scale.querySelector('.ramp').style.background =
            `linear-gradient(to right, ${RAMP.map((c) => `rgb(${c.join()})`).join()})`;
        const [low, high] = this.rangeOf(mode);
        scale.querySelector('.low').textContent = low;
        scale.querySelector('.high').textContent = high;
      }
      const bytesOf = ['class', 'probability', 'variance', 'evidence'];
      const channel = bytesOf.map((name) => (name === mode.replace('-safe', '') ? 1 : 0));
      this.scene.setColors(bytes, channel, mode === 'height' ? this.heightScale() : [0, 0, 0, 0]);
    }

    heightScale() {
      const {axis, sign} = this.header.up;
      const {low, high} = this.header.layers;
      const scale = 255 / (high + 1 - low);
      const factors = [0, 0, 0, -low * scale];
      factors[axis] = sign * scale;
      return factors;
    }

    rangeOf(mode) {
      if (mode === 'probability') return ['0', '1'];
      if (mode === 'height') {
        const {low, high} = this.header.layers;
        return [`${format(this.heightOf(low))} m`, `${format(this.heightOf(high + 1))} m`];
      }
      const {min, max} = this.header[mode];
      return [format(min), `${format(max)} (logarithmic)`];
    }

    choose(hit) {
      this.scene.mark(hit);
      const box = this.find('.voxel');
      box.hidden = hit === undefined;
      if (hit) this.tellVoxel(box.querySelector('.content'), hit);
    }

    tellVoxel(content, hit) {
      const table = document.createElement('table');
      let rest = 1;
      for (const {id, probability} of this.model.classVector(hit.voxel)) {
        table.append(
            this.vectorRow(this.swatch(id), this.header.classNames[id].name, probability));
        rest -= probability;
      }
      if (rest > 0.005) table.append(this.vectorRow('', 'all others together', rest));
      const half = hit.size / 2;
      const place = hit.corner.map((c) => format((c + half) * this.header.resolution, 4));
      const note = document.createElement('p');
      note.textContent = `At ${place.join(', ')} m. Evidence ` +
          `${format(this.model.evidence(hit.voxel))}, variance ` +
          `${format(this.model.variance(hit.voxel))}.` +
          (hit.size > 1 ? ' The best known voxel of this cube; come nearer for the others.' : '');
      content.replaceChildren(table, note);
    }

    vectorRow(swatch, name, probability) {
      const row = document.createElement('tr');
      const cell = (...parts) => {
        const data = document.createElement('td');
        data.append(...parts);
        row.append(data);
        return data;
      };
      cell(swatch, name).className = 'text';
      const bar = document.createElement('span');
      bar.style.width = `${100 * probability}%`;
      cell(bar).className = 'bar';
      cell(`${(100 * probability).toFixed(1)} %`);
      return row;
    }
  }

  async function open() {
    const section = document.getElementById('viewer');
    const status = section.querySelector('.status');
    status.textContent = 'Unpacking the map …';
    try {
      const header = JSON.parse(document.getElementById('viewer-header').textContent);
      const data = document.getElementById('viewer-data');
      const model = await VoxelModel.unpack(header, data.textContent.trim());
      data.remove();  // megabytes of text
      new Panel(section, header, model);
      status.remove();
    } catch (error) {
      status.textContent = 'This browser cannot show the map in three dimensions: it has no WebGL ' +
          'or is older than 2023. The pictures below show the same map.';
      section.classList.add('failed');
      console.warn(error);
    }
  }

  open();
})();
