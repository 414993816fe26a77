"use strict";

/* Games and how they are drawn. Places are in units from a panel's origin, as they lie in the
   page (`animation/player.py` says how), until a view turns them into pixels. */

const HEADING_UNIT = 0.01;
/* Lines of the games over each other, the solid one first [pixels drawn, left out, …]. */
const DASHES = [[], [7, 4], [2, 3], [8, 3, 2, 3], [12, 5], [4, 2, 1, 2, 1, 2]];
/* Around the axes [pixels]. */
const MARGIN = { left: 46, right: 10, top: 8, bottom: 36 };
/* The share of the extent that is added around it, and the least that a close-up shows. */
const AROUND = 0.16;
const CLOSEST = 1 / 25;

const dashes = (style) => DASHES[style % DASHES.length];

function unpacked(steps) {
  let sum = 0;
  return Float64Array.from(steps, (step) => (sum += step));
}

class Game {
  constructor(packed) {
    Object.assign(this, packed);
    this.robots = packed.robots.map((robot) => {
      const [x, y] = [unpacked(robot.x), unpacked(robot.y)];
      const heading = unpacked(robot.heading).map((steps) => steps * HEADING_UNIT);
      return { ...robot, x, y, heading, ...traced(x, y) };
    });
    this.wall = packed.wall && { x: unpacked(packed.wall.x), y: unpacked(packed.wall.y) };
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

/* The points of a path that a screen tells apart, where in the path each is, and their line. */
function traced(x, y) {
  const points = [];
  const whole = new Path2D();
  let [atX, atY] = [Infinity, Infinity];
  for (let index = 0; index < x.length; index += 1) {
    if (Math.abs(x[index] - atX) + Math.abs(y[index] - atY) > 3 || index === x.length - 1) {
      [atX, atY] = [x[index], y[index]];
      points.push({ x: atX, y: atY, index });
      whole.lineTo(atX, atY);
    }
  }
  return { points, whole };
}

/* A value between two of a path's. */
function between(values, place) {
  const index = Math.floor(place);
  const part = place - index;
  return part === 0 ? values[index] : values[index] * (1 - part) + values[index + 1] * part;
}

/* The smallest box around points. */
function extent(points) {
  const box = { left: Infinity, right: -Infinity, bottom: Infinity, top: -Infinity };
  for (const [x, y] of points) {
    box.left = Math.min(box.left, x);
    box.right = Math.max(box.right, x);
    box.bottom = Math.min(box.bottom, y);
    box.top = Math.max(box.top, y);
  }
  const [width, height] = [box.right - box.left, box.top - box.bottom];
  const middle = { x: (box.left + box.right) / 2, y: (box.bottom + box.top) / 2 };
  return { width, height, middle, span: Math.max(width, height) };
}

/* The step of an axis, 1, 2 or 5 times a power of ten, that has at most so many ticks. */
function tickStep(span, most) {
  const rough = span / Math.max(most, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  return power * ([1, 2, 5].find((factor) => factor * power >= rough * 0.999) ?? 10);
}

class Scene {
  /* `colour(index)` is what a robot is drawn in. */
  constructor(canvas, colour) {
    this.canvas = canvas;
    this.pen = canvas.getContext("2d");
    this.colour = colour;
  }

  /* Show other games: all that are drawn over each other. */
  show(panel, games) {
    this.panel = panel;
    this.games = games;
    const parts = games.flatMap((game) => [...game.robots, ...(game.wall ? [game.wall] : [])]);
    const points = function* () {
      for (const { x, y } of parts) for (let index = 0; index < x.length; index += 1) yield [x[index], y[index]];
    };
    this.whole = extent(points());
    this.whole.span ||= 1;
    this.fit();
  }

  /* Make the canvas as wide as there is room, and as sharp as the screen. */
  fit() {
    const { width, height, span } = this.whole;
    const room = Math.max(this.canvas.parentElement.clientWidth, 160);
    const [aside, above] = [MARGIN.left + MARGIN.right, MARGIN.top + MARGIN.bottom];
    const tall = (height + AROUND * span) / (width + AROUND * span);
    const high = Math.round(Math.min(Math.max(tall, 0.3) * (room - aside) + above, 520));
    const ratio = window.devicePixelRatio || 1;
    this.canvas.style.height = `${high}px`;
    this.canvas.width = Math.round(room * ratio);
    this.canvas.height = Math.round(high * ratio);
    this.pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.size = { width: room, height: high };
    this.frame = { left: MARGIN.left, top: MARGIN.top, width: room - aside, height: high - above };
  }

  /* Which places the frame shows: all, or where the robots are at a time. */
  look(time, games, closeUp) {
    const { whole, frame } = this;
    let box = whole;
    let around = AROUND * whole.span;
    if (closeUp && games.length > 0) {
      const robots = games.flatMap((game) => game.robots.map((robot) => [robot, game.place(robot, time)]));
      box = extent(robots.map(([robot, place]) => [between(robot.x, place), between(robot.y, place)]));
      around = Math.max(CLOSEST * whole.span, AROUND * box.span);
    }
    this.middle = box.middle;
    this.scale = Math.min(frame.width / (box.width + around), frame.height / (box.height + around));
  }

  x(units) {
    return this.frame.left + this.frame.width / 2 + (units - this.middle.x) * this.scale;
  }

  y(units) {
    return this.frame.top + this.frame.height / 2 - (units - this.middle.y) * this.scale;
  }

  /* Draw a moment; `hidden` has the labels of games that are not shown. */
  draw(time, hidden, closeUp) {
    const style = getComputedStyle(this.canvas);
    this.ink = style.color;
    this.rule = style.borderTopColor;
    this.paper = style.backgroundColor;
    const { pen, frame } = this;
    const games = this.games.filter((game) => !hidden.has(game.label));
    this.look(time, games, closeUp);
    pen.clearRect(0, 0, this.size.width, this.size.height);
    this.axes();
    pen.save();
    pen.beginPath();
    pen.rect(frame.left, frame.top, frame.width, frame.height);
    pen.clip();
    pen.lineJoin = "round";
    for (const game of games) if (game.wall) this.wall(game.wall);
    for (const game of games) for (const robot of game.robots) this.path(game, robot, time);
    for (const game of games) for (const robot of game.robots) this.robot(game, robot, time);
    pen.restore();
  }

  axes() {
    const { pen, frame } = this;
    const { origin, unit } = this.panel;
    const metre = this.scale / unit;
    const step = tickStep(frame.width / metre, frame.width / 60);
    const digits = Math.min(Math.max(0, -Math.floor(Math.log10(step) + 1e-9)), 6);
    const said = (value) => {
      const text = Math.abs(value) >= 1e6 ? value.toPrecision(7) : value.toFixed(digits);
      return Number(text) === 0 ? "0" : text.replace("-", "−");
    };
    /* Ticks are whole multiples of the step from the world's origin, not from the panel's. */
    const each = (start, middle, length, at) => {
      const low = middle * unit - length / metre / 2;
      const first = Math.ceil((start + low) / step) * step - start;
      const count = Math.floor((length / metre - (first - low)) / step + 1e-9);
      for (let index = 0; index <= count; index += 1) {
        const value = first + index * step;
        at(value / unit, said(start + value));
      }
    };
    pen.font = "11px system-ui, sans-serif";
    pen.strokeStyle = this.rule;
    pen.fillStyle = this.ink;
    pen.lineWidth = 1;
    pen.textAlign = "center";
    pen.textBaseline = "top";
    each(origin[0], this.middle.x, frame.width, (value, text) => {
      const x = Math.round(this.x(value)) + 0.5;
      this.line(x, frame.top, x, frame.top + frame.height);
      pen.fillText(text, x, frame.top + frame.height + 5);
    });
    pen.fillText("x [m]", frame.left + frame.width / 2, frame.top + frame.height + 20);
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    each(origin[1], this.middle.y, frame.height, (value, text) => {
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
    const { pen, scale } = this;
    const place = game.place(robot, time);
    pen.strokeStyle = this.colour(robot.colour);
    pen.fillStyle = pen.strokeStyle;
    pen.save();
    pen.translate(this.x(0), this.y(0));
    pen.scale(scale, -scale);
    pen.setLineDash(dashes(game.style).map((length) => length / scale));
    pen.lineWidth = 1.5 / scale;
    pen.globalAlpha = 0.22;
    pen.stroke(robot.whole);
    pen.globalAlpha = 1;
    pen.lineWidth = 1.8 / scale;
    pen.beginPath();
    for (const point of robot.points) {
      if (point.index > place) break;
      pen.lineTo(point.x, point.y);
    }
    pen.lineTo(between(robot.x, place), between(robot.y, place));
    pen.stroke();
    pen.restore();
    pen.beginPath();
    pen.arc(this.x(robot.x[0]), this.y(robot.y[0]), 2.6, 0, 2 * Math.PI);
    pen.fill();
  }

  /* A triangle like a car's outline from above, with the circle in which a pursuer captures; a
     ring where an evader was captured. */
  robot(game, robot, time) {
    const { pen } = this;
    const place = game.place(robot, time);
    const [x, y] = [this.x(between(robot.x, place)), this.y(between(robot.y, place))];
    pen.strokeStyle = this.colour(robot.colour);
    pen.fillStyle = game.style === 0 ? pen.strokeStyle : this.paper;
    pen.lineWidth = 1.4;
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
    const circle = (radius) => {
      pen.beginPath();
      pen.arc(x, y, radius, 0, 2 * Math.PI);
      pen.stroke();
    };
    if (robot.role === "pursuer" && game.radius !== null) {
      circle((game.radius / this.panel.unit) * this.scale);
    }
    const captured = game.captured !== null && time >= game.captured - 1e-6;
    if (robot.role === "evader" && captured) circle(12);
  }
}
