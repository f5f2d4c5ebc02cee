// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Plays the frames of a comparison: two pictures beside each other, in turns, or their difference; curves to click on.
"use strict";

/** The number of the frame after `index` by so many steps, round and round. */
function stepped(index, by, count) {
  return (((index + by) % count) + count) % count;
}

/** The frame's number under `x` on a chart whose plot begins at `left` and is `width` wide. */
function indexAt(x, left, width, count) {
  const share = width > 0 ? (x - left) / width : 0;
  return Math.min(Math.max(Math.round(share * (count - 1)), 0), count - 1);
}

/** Where frame `index` is on such a chart. */
function xOf(index, left, width, count) {
  return count > 1 ? left + (width * index) / (count - 1) : left + width / 2;
}

/** Least and largest of all numbers in rows, from 0 where no number is below; [0, 1] without numbers. */
function rangeOf(rows) {
  const known = rows.flat().filter((value) => value !== null);
  if (!known.length) return [0, 1];
  const low = Math.min(0, ...known), high = Math.max(...known);
  return high > low ? [low, high] : [low, low + 1];
}

/** Runs of points [x, y] of a curve: it is broken where a frame has no number. */
function runsOf(values, toX, toY) {
  const runs = [];
  let run = [];
  values.forEach((value, index) => {
    if (value === null) {
      if (run.length) runs.push(run);
      run = [];
    } else {
      run.push([toX(index), toY(value)]);
    }
  });
  if (run.length) runs.push(run);
  return runs;
}

/** A number as people read it, with so many decimals. */
function told(value, decimals) {
  return value === null || value === undefined ? "-" : value.toFixed(decimals);
}

/** Numbers of frames from the worst to the best by one measure of one method; those without a number are left out. */
function worstFirst(values, isBetterHigh) {
  const order = values.map((value, index) => index).filter((index) => values[index] !== null);
  const sign = isBetterHigh ? 1 : -1;
  return order.sort((a, b) => sign * (values[a] - values[b]) || a - b);
}

/** The next frame in the order of the worst, after the present one; the first where the present is not in it. */
function nextWorst(order, index) {
  return order.length ? order[(order.indexOf(index) + 1) % order.length] : index;
}

/** What a key does, or nothing. */
function actionOf(key) {
  const actions = {
    " ": "play", ArrowRight: "next", ArrowLeft: "previous", Home: "first", End: "last", ArrowUp: "methodUp",
    ArrowDown: "methodDown", s: "side", f: "flip", d: "difference", w: "worst",
  };
  return actions[key] || "";
}

function start(data) {
  const $ = (id) => document.getElementById(id);
  const count = data.frames.length;
  const images = new Map();
  const state = { index: 0, mode: "side", isPlaying: false, isSecond: false, timer: 0 };
  const svg = $("curve");
  const box = { width: 900, height: 220, left: 56, right: 12, top: 10, bottom: 24 };
  const plot = box.width - box.left - box.right;

  const source = (index, name) => `${data.frames[index].folder}/${name}.png`;

  /** Loads a picture ahead, once. */
  function load(index, name) {
    const path = source(index, name);
    if (!images.has(path)) {
      const image = new Image();
      image.src = path;
      images.set(path, image);
    }
    return images.get(path);
  }

  function show(index) {
    state.index = index;
    const left = $("left").value, right = $("right").value;
    const shown = { "picture-left": left, "picture-right": right, "picture-below": left, "picture-above": right };
    for (const [id, name] of Object.entries(shown)) $(id).src = source(index, name);
    const frame = data.frames[index];
    $("scrub").value = index;
    $("frame").textContent = `frame ${frame.frame}`;
    $("cut").textContent = frame.cut ? `cut: ${frame.cut}` : "";
    $("own").href = `${frame.folder}/report.html`;
    const measure = data.measures.find((one) => one.key === $("measure").value);
    const numbers = data.values[measure.key][right];
    $("number").textContent = numbers ? `${measure.label}: ${told(numbers[index], measure.decimals)}` : "";
    $("cursor").setAttribute("x1", xOf(index, box.left, plot, count));
    $("cursor").setAttribute("x2", xOf(index, box.left, plot, count));
    for (let ahead = 1; ahead <= 8; ahead += 1) {
      load(stepped(index, ahead, count), left);
      load(stepped(index, ahead, count), right);
    }
  }

  function setMode(mode) {
    state.mode = mode;
    for (const name of ["side", "flip", "difference"]) $(`mode-${name}`).setAttribute("aria-pressed", name === mode);
    $("side").hidden = mode !== "side";
    $("stack").hidden = mode === "side";
    $("stack").className = `stack ${mode}`;
    turn(false);
  }

  /** Which of the two pictures is in front while they flip. */
  function turn(isSecond) {
    state.isSecond = isSecond;
    $("picture-above").style.visibility = state.mode === "flip" && !isSecond ? "hidden" : "visible";
    const [left, right] = ["left", "right"].map((id) => $(id).selectedOptions[0].textContent);
    const texts = { side: `${left} | ${right}`, flip: isSecond ? right : left, difference: `Difference of ${left} and ${right}, x8` };
    $("which").textContent = texts[state.mode];
  }

  function drawCurve() {
    const measure = data.measures.find((one) => one.key === $("measure").value);
    const rows = data.values[measure.key];
    const [low, high] = rangeOf(Object.values(rows));
    const tall = box.height - box.top - box.bottom;
    const toX = (index) => xOf(index, box.left, plot, count);
    const toY = (value) => box.top + tall * (1 - (value - low) / (high - low));
    const part = (name, attributes, text) => {
      const made = document.createElementNS("http://www.w3.org/2000/svg", name);
      for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
      if (text !== undefined) made.textContent = text;
      svg.insertBefore(made, $("cursor"));
    };
    svg.querySelectorAll(":scope > :not(#cursor)").forEach((old) => old.remove());
    for (const share of [0, 0.5, 1]) {
      const value = low + share * (high - low);
      part("line", { x1: box.left, x2: box.width - box.right, y1: toY(value), y2: toY(value), class: "grid" });
      const text = told(value, Math.max(measure.decimals, high - low < 2 ? 2 : 0));
      part("text", { x: box.left - 6, y: toY(value) + 4, "text-anchor": "end" }, text);
    }
    for (const index of new Set([0, Math.floor((count - 1) / 2), count - 1])) {
      part("text", { x: toX(index), y: box.height - 6, "text-anchor": "middle" }, data.frames[index].frame);
    }
    data.frames.forEach((frame, index) => {
      if (frame.cut) part("line", { x1: toX(index), x2: toX(index), y1: box.top, y2: box.top + tall, class: "cut" });
    });
    for (const [name, values] of Object.entries(rows)) {
      const dash = data.peers.includes(name) ? "5 3" : "none";
      const wide = name === $("right").value ? 3 : 1.5;
      for (const run of runsOf(values, toX, toY)) {
        const points = run.map((point) => point.map((number) => number.toFixed(1)).join(",")).join(" ");
        part("polyline", { points, style: `stroke:${data.colors[name]}`, "stroke-dasharray": dash, "stroke-width": wide });
        if (run.length === 1) part("circle", { cx: run[0][0], cy: run[0][1], r: 2.5, style: `fill:${data.colors[name]}` });
      }
    }
    const name = $("right").value;
    const order = rows[name] ? worstFirst(rows[name], measure.isBetterHigh).slice(0, 6) : [];
    $("worst").replaceChildren(...order.map((index) => {
      const button = document.createElement("button");
      button.textContent = `${data.frames[index].frame}: ${told(rows[name][index], measure.decimals)}`;
      button.addEventListener("click", () => { pause(); show(index); });
      return button;
    }));
    show(state.index);
  }

  function tick() {
    if (!state.isPlaying) return;
    const next = stepped(state.index, 1, count);
    const ready = [$("left").value, $("right").value].every((name) => load(next, name).complete);
    // (What is not loaded is waited for.)
    if (ready) show(next);
    state.timer = window.setTimeout(tick, 1000 / Number($("speed").value));
  }

  function play() {
    state.isPlaying = true;
    $("play").textContent = "Pause";
    tick();
  }

  function pause() {
    state.isPlaying = false;
    window.clearTimeout(state.timer);
    $("play").textContent = "Play";
  }

  function choose(by) {
    const chosen = $("right");
    chosen.selectedIndex = stepped(chosen.selectedIndex, by, chosen.options.length);
    changed();
  }

  function changed() {
    turn(state.isSecond);
    drawCurve();
  }

  function worst() {
    const measure = data.measures.find((one) => one.key === $("measure").value);
    const values = data.values[measure.key][$("right").value];
    pause();
    if (values) show(nextWorst(worstFirst(values, measure.isBetterHigh), state.index));
  }

  const actions = {
    play: () => (state.isPlaying ? pause() : play()),
    next: () => { pause(); show(stepped(state.index, 1, count)); },
    previous: () => { pause(); show(stepped(state.index, -1, count)); },
    first: () => { pause(); show(0); },
    last: () => { pause(); show(count - 1); },
    methodUp: () => choose(-1),
    methodDown: () => choose(1),
    side: () => setMode("side"),
    flip: () => (state.mode === "flip" ? turn(!state.isSecond) : setMode("flip")),
    difference: () => setMode("difference"),
    worst,
  };
  document.addEventListener("keydown", (event) => {
    const action = actionOf(event.key);
    // (Menus have their own keys.)
    if (!action || event.target.tagName === "SELECT" || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    actions[action]();
  });
  for (const id of ["play", "next", "previous"]) $(id).addEventListener("click", actions[id]);
  $("next-worst").addEventListener("click", worst);
  for (const mode of ["side", "flip", "difference"]) $(`mode-${mode}`).addEventListener("click", actions[mode]);
  $("stack").addEventListener("click", () => { if (state.mode === "flip") turn(!state.isSecond); });
  $("scrub").addEventListener("input", () => { pause(); show(Number($("scrub").value)); });
  for (const id of ["left", "right", "measure"]) $(id).addEventListener("change", changed);
  const follow = (event) => {
    const frame = svg.getBoundingClientRect();
    const x = ((event.clientX - frame.left) * box.width) / frame.width;
    pause();
    show(indexAt(x, box.left, plot, count));
  };
  svg.addEventListener("pointerdown", (event) => { svg.setPointerCapture(event.pointerId); follow(event); });
  svg.addEventListener("pointermove", (event) => { if (event.buttons) follow(event); });
  document.querySelectorAll("[data-frame]").forEach((link) => {
    link.addEventListener("click", () => {
      pause();
      if (link.dataset.name) $("right").value = link.dataset.name;
      if (link.dataset.measure) $("measure").value = link.dataset.measure;
      state.index = data.frames.findIndex((frame) => frame.frame === Number(link.dataset.frame));
      changed();
    });
  });
  setMode("side");
  drawCurve();
}

if (typeof document === "undefined") {
  module.exports = { stepped, indexAt, xOf, rangeOf, runsOf, told, worstFirst, nextWorst, actionOf };
} else {
  start(JSON.parse(document.getElementById("data").textContent));
}
