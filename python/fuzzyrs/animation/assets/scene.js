"use strict";

/* Games and how they are drawn. Places are in metres from a panel's origin until `Scene` turns
   them into pixels; `animation/player.py` says how they lie in the page. */

const HEADING_UNIT = 0.01;
/* Lines of the recordings over each other, the solid one first [pixels drawn, left out, …]. */
const DASHES = [[], [7, 4], [2, 3], [8, 3, 2, 3], [12, 5], [4, 2, 1, 2, 1, 2]];

const dashes = (style) => DASHES[style % DASHES.length];

function unpacked(steps, unit) {
  let sum = 0;
  return Float64Array.from(steps, (step) => (sum += step) * unit);
}

class Game {
  constructor(packed, unit) {
    Object.assign(this, packed);
    this.robots = packed.robots.map((robot) => ({
      ...robot,
      x: unpacked(robot.x, unit),
      y: unpacked(robot.y, unit),
      heading: unpacked(robot.heading, HEADING_UNIT),
    }));
    this.wall = packed.wall && {
      x: unpacked(packed.wall.x, unit),
      y: unpacked(packed.wall.y, unit),
    };
    const steps = Math.max(...this.robots.map((robot) => robot.x.length)) - 1;
    this.duration = steps * this.step;
  }

  /* Where in a robot's path it is at a time; behind the end it stands still. */
  place(robot, time) {
    const last = robot.x.length - 1;
    const exact = this.step > 0 ? time / this.step : last;
    /* A time on a step is that step, in spite of rounding. */
    const near = Math.round(exact);
    return Math.min(Math.abs(exact - near) < 1e-6 ? near : exact, last);
  }
}

/* A value between two of a path's. */
function between(values, place) {
  const index = Math.floor(place);
  const part = place - index;
  return part === 0 ? values[index] : values[index] * (1 - part) + values[index + 1] * part;
}

/* The step of an axis, 1, 2 or 5 times a power of ten, that has at most so many ticks. */
function tickStep(span, most) {
  const rough = span / Math.max(most, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  return power * ([1, 2, 5].find((factor) => factor * power >= rough * 0.999) ?? 10);
}

class Scene {
  /* `colours(index)` is what a robot is drawn in. */
  constructor(canvas, colours) {
    this.canvas = canvas;
    this.pen = canvas.getContext("2d");
    this.colours = colours;
  }

  /* Show other games: all that are drawn over each other. */
  show(panel, games) {
    this.panel = panel;
    this.games = games;
    const bounds = { left: Infinity, right: -Infinity, bottom: Infinity, top: -Infinity };
    for (const { x, y } of games.flatMap((game) => [...game.robots, game.wall ?? []])) {
      for (const value of x ?? []) {
        bounds.left = Math.min(bounds.left, value);
        bounds.right = Math.max(bounds.right, value);
      }
      for (const value of y ?? []) {
        bounds.bottom = Math.min(bounds.bottom, value);
        bounds.top = Math.max(bounds.top, value);
      }
    }
    this.bounds = bounds;
    this.fit();
  }

  /* Make the canvas as sharp as the screen, and everything as large as it fits. */
  fit() {
    const { left, right, bottom, top } = this.bounds;
    const span = Math.max(right - left, top - bottom) || 1;
    const width = Math.max(this.canvas.parentElement.clientWidth, 160);
    const tall = (top - bottom + 0.16 * span) / (right - left + 0.16 * span);
    const height = Math.round(Math.min(Math.max(tall, 0.5) * (width - 56) + 44, 520));
    const ratio = window.devicePixelRatio || 1;
    this.canvas.style.height = `${height}px`;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    this.pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.frame = { left: 46, top: 8, width: width - 56, height: height - 44 };
    this.scale = Math.min(
      this.frame.width / (right - left + 0.16 * span),
      this.frame.height / (top - bottom + 0.16 * span),
    );
    this.middle = { x: (left + right) / 2, y: (bottom + top) / 2 };
    for (const robot of this.games.flatMap((game) => game.robots)) this.trace(robot);
  }

  x(metres) {
    return this.frame.left + this.frame.width / 2 + (metres - this.middle.x) * this.scale;
  }

  y(metres) {
    return this.frame.top + this.frame.height / 2 - (metres - this.middle.y) * this.scale;
  }

  /* Keep the points of a path that a screen tells apart, and where in the path each is. */
  trace(robot) {
    const points = [];
    let [atX, atY] = [Infinity, Infinity];
    const last = robot.x.length - 1;
    for (let index = 0; index <= last; index += 1) {
      const [x, y] = [this.x(robot.x[index]), this.y(robot.y[index])];
      if (Math.abs(x - atX) + Math.abs(y - atY) > 0.7 || index === last) {
        points.push({ x, y, index });
        [atX, atY] = [x, y];
      }
    }
    robot.points = points;
    robot.whole = new Path2D();
    for (const { x, y } of points) robot.whole.lineTo(x, y);
  }

  /* Draw the moment; `hidden` has the labels of games that are not shown. */
  draw(time, hidden) {
    const style = getComputedStyle(this.canvas);
    this.ink = style.color;
    this.rule = style.borderTopColor;
    this.paper = style.backgroundColor;
    const { pen, frame } = this;
    pen.clearRect(0, 0, frame.width + 56, frame.height + 44);
    this.axes();
    pen.save();
    pen.beginPath();
    pen.rect(frame.left, frame.top, frame.width, frame.height);
    pen.clip();
    pen.lineJoin = "round";
    const games = this.games.filter((game) => !hidden.has(game.label));
    for (const game of games) if (game.wall) this.wall(game.wall);
    for (const game of games) for (const robot of game.robots) this.path(game, robot, time);
    for (const game of games) for (const robot of game.robots) this.robot(game, robot, time);
    pen.restore();
  }

  axes() {
    const { pen, frame, scale } = this;
    const [originX, originY] = this.panel.origin;
    const step = tickStep(frame.width / scale, frame.width / 60);
    const digits = Math.min(Math.max(0, -Math.floor(Math.log10(step) + 1e-9)), 6);
    const said = (value) =>
      (Math.abs(value) >= 1e6 ? value.toPrecision(7) : (value + 0).toFixed(digits)).replace("-", "−");
    pen.font = "11px system-ui, sans-serif";
    pen.strokeStyle = this.rule;
    pen.fillStyle = this.ink;
    pen.lineWidth = 1;
    const each = (origin, middle, length, at) => {
      const low = middle - length / scale / 2;
      /* Ticks are whole multiples of the step from the world's origin, not from the panel's. */
      const first = Math.ceil((origin + low) / step) * step - origin;
      const count = Math.floor(length / scale / step + 1e-9);
      for (let index = 0; index <= count; index += 1) {
        const value = first + index * step;
        if (value <= low + length / scale) at(value, said(origin + value));
      }
    };
    pen.textAlign = "center";
    pen.textBaseline = "top";
    each(originX, this.middle.x, frame.width, (value, text) => {
      const x = Math.round(this.x(value)) + 0.5;
      this.line(x, frame.top, x, frame.top + frame.height);
      pen.fillText(text, x, frame.top + frame.height + 5);
    });
    pen.fillText("x [m]", frame.left + frame.width / 2, frame.top + frame.height + 20);
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    each(originY, this.middle.y, frame.height, (value, text) => {
      const y = Math.round(this.y(value)) + 0.5;
      this.line(frame.left, y, frame.left + frame.width, y);
      pen.fillText(text, frame.left - 6, y);
    });
    pen.save();
    pen.translate(8, frame.top + frame.height / 2);
    pen.rotate(-Math.PI / 2);
    pen.textAlign = "center";
    pen.fillText("y [m]", 0, 0);
    pen.restore();
  }

  line(x1, y1, x2, y2) {
    this.pen.beginPath();
    this.pen.moveTo(x1, y1);
    this.pen.lineTo(x2, y2);
    this.pen.stroke();
  }

  wall({ x, y }) {
    const { pen } = this;
    pen.beginPath();
    for (let index = 0; index < x.length; index += 1) pen.lineTo(this.x(x[index]), this.y(y[index]));
    pen.strokeStyle = this.ink;
    pen.lineWidth = 2.5;
    pen.stroke();
  }

  /* Where a robot goes, faint, and where it has been. */
  path(game, robot, time) {
    const { pen } = this;
    const place = game.place(robot, time);
    pen.strokeStyle = this.colours(robot.colour);
    pen.setLineDash(dashes(game.style));
    pen.lineWidth = 1.5;
    pen.globalAlpha = 0.22;
    pen.stroke(robot.whole);
    pen.globalAlpha = 1;
    pen.lineWidth = 1.8;
    pen.beginPath();
    for (const point of robot.points) {
      if (point.index > place) break;
      pen.lineTo(point.x, point.y);
    }
    pen.lineTo(this.x(between(robot.x, place)), this.y(between(robot.y, place)));
    pen.stroke();
    pen.setLineDash([]);
    pen.fillStyle = pen.strokeStyle;
    pen.beginPath();
    pen.arc(robot.points[0].x, robot.points[0].y, 2.6, 0, 2 * Math.PI);
    pen.fill();
  }

  /* A triangle like a car's outline from above, with the circle in which a pursuer captures; a
     ring where an evader was captured. */
  robot(game, robot, time) {
    const { pen } = this;
    const place = game.place(robot, time);
    const [x, y] = [this.x(between(robot.x, place)), this.y(between(robot.y, place))];
    pen.strokeStyle = this.colours(robot.colour);
    pen.fillStyle = game.style === 0 ? pen.strokeStyle : this.paper;
    pen.lineWidth = 1.4;
    const circle = (radius) => {
      pen.beginPath();
      pen.arc(x, y, radius, 0, 2 * Math.PI);
      pen.stroke();
    };
    pen.save();
    pen.translate(x, y);
    pen.rotate(-between(robot.heading, place));
    pen.beginPath();
    pen.moveTo(8, 0);
    pen.lineTo(-6, 4.6);
    pen.lineTo(-4, 0);
    pen.lineTo(-6, -4.6);
    pen.closePath();
    pen.fill();
    pen.stroke();
    pen.restore();
    pen.lineWidth = 1;
    if (robot.role === "pursuer" && game.radius !== null) circle(game.radius * this.scale);
    const captured = game.captured !== null && time >= game.captured - 1e-6;
    if (robot.role === "evader" && captured) circle(12);
  }
}
