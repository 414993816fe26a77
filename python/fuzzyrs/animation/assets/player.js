"use strict";

/* What a reader operates: play, pause, scrub, speed, which games. Nothing runs while it rests. */

const SPEEDS = [0.5, 1, 2, 4, 8];
const ICONS = { play: "M4 2.5 L13 8 L4 13.5 Z", pause: "M4 3 H7 V13 H4 Z M9.5 3 H12.5 V13 H9.5 Z" };

function made(name, options = {}, children = []) {
  const { attributes = {}, ...properties } = options;
  const node = Object.assign(document.createElement(name), properties);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}

/* A small drawing beside words. */
function drawing(width, height, path, attributes) {
  const space = "http://www.w3.org/2000/svg";
  const [svg, shape] = [document.createElementNS(space, "svg"), document.createElementNS(space, "path")];
  const size = { width, height, viewBox: `0 0 ${width} ${height}`, "aria-hidden": "true" };
  for (const [key, value] of Object.entries(size)) svg.setAttribute(key, value);
  for (const [key, value] of Object.entries({ d: path, ...attributes })) shape.setAttribute(key, value);
  svg.append(shape);
  return svg;
}

class Player {
  constructor(root) {
    this.root = root;
    this.panels = JSON.parse(root.querySelector(".player-data").textContent).panels;
    this.hidden = new Set();
    this.playing = false;
    this.build();
    this.scene = new Scene(this.canvas, (index) => this.colour(index));
    this.choose(0);
    this.listen();
  }

  build() {
    this.canvas = made("canvas", { tabIndex: 0, attributes: { role: "img" } });
    this.button = made("button", { type: "button", className: "player-play" });
    this.range = made("input", { type: "range", min: "0", attributes: { "aria-label": "time" } });
    this.output = made("output", { className: "player-time" });
    this.speed = made("select", { attributes: { "aria-label": "speed" } });
    this.choice = made("select", { attributes: { "aria-label": "game" } });
    this.choice.append(
      ...this.panels.map((panel, index) =>
        made("option", { value: index, textContent: panel.name || `game ${index + 1}` }),
      ),
    );
    this.choice.hidden = this.panels.length < 2;
    this.closeUp = made("input", { type: "checkbox" });
    const closeUp = made("label", { className: "player-close-up" }, [this.closeUp, "close-up"]);
    this.legend = made("div", { className: "player-legend" });
    const bar = [this.button, this.range, this.output, this.speed];
    this.root.querySelector(".player-missing").remove();
    this.root.append(
      made("div", { className: "player-choice" }, [this.choice, closeUp]),
      made("div", { className: "player-canvas" }, [this.canvas]),
      made("div", { className: "player-bar" }, bar),
      this.legend,
    );
  }

  /* Show another panel, at its end: its whole paths. */
  choose(index) {
    this.pause();
    const panel = this.panels[index];
    this.games = panel.games.map((game) => new Game(game));
    this.duration = Math.max(...this.games.map((game) => game.duration));
    this.step = Math.max(...this.games.map((game) => game.step)) || 1;
    this.range.max = this.duration;
    this.range.step = "any";
    this.setSpeeds(panel.speed);
    this.setLegend();
    this.canvas.setAttribute("aria-label", this.said(panel));
    this.scene.show(panel, this.games);
    this.seek(this.duration);
  }

  said(panel) {
    const games = this.games.map((game) => [game.label, game.outcome].filter(Boolean).join(": "));
    return [`paths of the robots`, panel.name, ...games].filter(Boolean).join("; ");
  }

  setSpeeds(usual) {
    const speeds = SPEEDS.includes(usual) ? SPEEDS : [...SPEEDS, usual / 4, usual, usual * 4];
    const several = [...new Set(speeds)].sort((one, other) => one - other);
    this.speed.replaceChildren(
      ...several.map((speed) =>
        made("option", { value: speed, textContent: speed === 0.5 ? "½×" : `${speed}×` }),
      ),
    );
    this.speed.value = usual;
  }

  /* Who has which colour, and which line each game; unchecking one hides it. */
  setLegend() {
    const robots = new Map(this.games.flatMap((game) => game.robots.map((robot) => [robot.name, robot])));
    const names = [...robots.values()].map((robot) =>
      made("span", { className: `player-name player-colour-${robot.colour % 7}` }, [
        drawing(14, 10, "M13 5 L1 9.5 L3 5 L1 0.5 Z", { fill: "currentColor" }),
        made("span", { textContent: robot.name || robot.role }),
      ]),
    );
    this.swatches = new Map([...robots.values()].map((robot, i) => [robot.colour, names[i]]));
    const games = this.games.map((game) => {
      const box = made("input", { type: "checkbox", checked: !this.hidden.has(game.label) });
      box.addEventListener("change", () => {
        if (box.checked) this.hidden.delete(game.label);
        else this.hidden.add(game.label);
        this.draw();
      });
      const line = { stroke: "currentColor", "stroke-width": 1.8, "stroke-dasharray": dashes(game.style) };
      const text = [game.label, game.outcome].filter(Boolean).join(": ");
      const words = made("span", { textContent: text });
      return made("label", { className: "player-game" }, [box, drawing(30, 6, "M0 3 H30", line), words]);
    });
    this.legend.replaceChildren(
      made("div", { className: "player-names" }, names),
      made("div", { className: "player-games" }, games),
    );
    if (games.length === 1) games[0].querySelector("input").hidden = true;
  }

  colour(index) {
    return getComputedStyle(this.swatches.get(index)).color;
  }

  listen() {
    this.button.addEventListener("click", () => this.toggle());
    this.range.addEventListener("input", () => this.seek(Number(this.range.value)));
    this.range.addEventListener("pointerdown", () => this.pause());
    this.closeUp.addEventListener("change", () => this.draw());
    this.choice.addEventListener("change", () => this.choose(Number(this.choice.value)));
    this.root.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.refit()).observe(this.canvas.parentElement);
    new MutationObserver(() => this.draw()).observe(document.documentElement, { attributes: true });
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    /* What nobody sees needs no frames. */
    new IntersectionObserver(([seen]) => seen.isIntersecting || this.pause()).observe(this.canvas);
  }

  key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    if (event.target !== this.canvas && event.target !== this.range) return;
    const stride = this.step * (event.shiftKey ? 10 : 1);
    const doings = {
      " ": () => this.toggle(),
      ArrowLeft: () => this.move(-stride),
      ArrowRight: () => this.move(stride),
      Home: () => this.move(-Infinity),
      End: () => this.move(Infinity),
    };
    if (!(event.key in doings)) return;
    event.preventDefault();
    doings[event.key]();
  }

  move(by) {
    this.pause();
    this.seek(Math.round((this.time + by) / this.step) * this.step);
  }

  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.duration);
    const digits = Math.min(Math.max(1, -Math.floor(Math.log10(this.step) + 1e-9)), 3);
    const text = (seconds) => seconds.toFixed(digits);
    this.range.value = this.time;
    this.range.setAttribute("aria-valuetext", `${text(this.time)} of ${text(this.duration)} seconds`);
    this.output.textContent = `${text(this.time)} / ${text(this.duration)} s`;
    this.draw();
  }

  draw() {
    this.scene.draw(this.time, this.hidden, this.closeUp.checked);
  }

  refit() {
    if (this.canvas.parentElement.clientWidth === 0) return;
    this.scene.fit();
    this.draw();
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  play() {
    if (this.time >= this.duration) this.seek(0);
    this.playing = true;
    this.name();
    let before = performance.now();
    const frame = (now) => {
      if (!this.playing) return;
      const passed = Math.max(now - before, 0) / 1000;
      before = now;
      this.seek(this.time + passed * Number(this.speed.value));
      if (this.time >= this.duration) this.pause();
      else requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  pause() {
    this.playing = false;
    this.name();
  }

  name() {
    const next = this.playing ? "pause" : "play";
    this.button.setAttribute("aria-label", next);
    this.button.replaceChildren(drawing(16, 16, ICONS[next], { fill: "currentColor" }));
  }
}

/* Players are made when they come near the window, or before the page is printed. */
(() => {
  const waiting = new Set(document.querySelectorAll(".player"));
  const start = (root) => waiting.delete(root) && new Player(root);
  const near = new IntersectionObserver(
    (seen) => seen.filter((entry) => entry.isIntersecting).forEach(({ target }) => start(target)),
    { rootMargin: "600px" },
  );
  waiting.forEach((root) => near.observe(root));
  window.addEventListener("beforeprint", () => [...waiting].forEach(start));
})();
