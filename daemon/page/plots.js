// Plots of the figures of a series over its time steps: PSNR, largest error, range of values. Each plot is also a
// slider: a click or an arrow key goes to a step.

import {by_id, element, set_text} from "./dom.js";
import * as format from "./format.js";
import {linear_axis, log_axis, round_steps} from "./plot_axis.js";

const kHeight = 150;
const kTop = 12;
const kRight = 10;
const kBottom = 20;
const kLetter = 6.6;      // width of a tick label's letter
const kDotsUpTo = 60;     // steps; more dots would overlap
const kLogFrom = 100;     // ratio of largest to smallest value from which on the axis is logarithmic
const kPage = 10;         // steps of Page Up and Page Down

const kPlots = [
  {name: "psnr", title: "PSNR", unit: "dB", low: psnr, high: psnr, is_top: (output) => output.lossless,
   text: format.quality, axis: (lows, highs) => linear_axis(lows, highs)},
  {name: "error", title: "Largest error", unit: "in the data's unit", low: error, high: error, is_top: () => false,
   text: (output) => format.number(output.max_error), axis: error_axis},
  {name: "range", title: "Values", unit: "smallest to largest", low: (output) => output.min,
   high: (output) => output.max, is_top: () => false,
   text: (output) => `${format.number(output.min)} to ${format.number(output.max)}`,
   axis: (lows, highs) => linear_axis(lows, highs)},
];

let outputs = [];
let place = 0;
let go_to = () => {};

function psnr(output) {
  return output.lossless ? null : output.psnr_db;
}

function error(output) {
  return output.max_error;
}

function error_axis(lows, highs) {
  const smallest = Math.min(...lows);
  const largest = Math.max(...highs);
  if (smallest > 0 && largest > kLogFrom * smallest) return log_axis(lows, highs);
  return linear_axis([0], [largest || 1]);
}

const known = (plot, output) => plot.low(output) !== null && plot.high(output) !== null;
const has_figure = (plot, output) => plot.is_top(output) || known(plot, output);

function svg(tag, attributes, text = "") {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.textContent = text;
  return made;
}

const round = (value) => Math.round(value * 10) / 10;

/** Returns the runs of consecutive steps with known figures, as arrays of step indices. */
function runs_of(plot) {
  const runs = [];
  outputs.forEach((output, step) => {
    if (!known(plot, output)) return;
    if (runs.at(-1)?.at(-1) === step - 1) runs.at(-1).push(step);
    else runs.push([step]);
  });
  return runs;
}

/** Returns the positions of the plot's parts. */
function layout_of(plot) {
  const shown = outputs.filter((output) => known(plot, output));
  const axis = shown.length > 0 ? plot.axis(shown.map(plot.low), shown.map(plot.high)) : null;
  const letters = Math.max(4, ...(axis ? axis.ticks.map(({text}) => text.length) : []));
  const left = Math.ceil(letters * kLetter) + 10;
  const width = Math.max(plot.drawing.getBoundingClientRect().width, left + kRight + 20);
  const last = Math.max(outputs.length - 1, 1);
  return {
    axis, left, width, right: width - kRight, bottom: kHeight - kBottom,
    x: (step) => round(left + (width - kRight - left) * step / last),
    y: (value) => round(kHeight - kBottom - (kHeight - kBottom - kTop) * axis.share(value)),
    step_at: (x) => Math.min(Math.max(Math.round(last * (x - left) / (width - kRight - left)), 0), outputs.length - 1),
  };
}

function draw_axes({axis, left, right, bottom, x, y}) {
  const parts = [];
  for (const {value, text} of axis?.ticks ?? []) {
    parts.push(svg("line", {class: "grid", x1: left, x2: right, y1: y(value), y2: y(value)}),
               svg("text", {x: left - 6, y: y(value) + 4, "text-anchor": "end"}, text));
  }
  parts.push(svg("text", {x: left - 6, y: bottom + 16, "text-anchor": "end"}, "step"));
  const room = Math.max(2, Math.floor((right - left) / 60));
  for (const number of round_steps(outputs.length, room)) {
    const half = String(number).length * kLetter / 2;
    parts.push(svg("text", {x: Math.min(x(number - 1), right + kRight - half), y: bottom + 16, "text-anchor": "middle"},
                   String(number)));
  }
  return parts;
}

function line_of(run, value, {x, y}) {
  return run.map((step) => `${x(step)},${y(value(outputs[step]))}`).join(" ");
}

function draw_run(plot, run, layout) {
  const high = line_of(run, plot.high, layout);
  if (plot.low === plot.high) return [svg("polyline", {class: "line", points: high})];
  const back = line_of([...run].reverse(), plot.low, layout);
  return [svg("polygon", {class: "band", points: `${high} ${back}`}),
          svg("polyline", {class: "line", points: high}),
          svg("polyline", {class: "line", points: line_of(run, plot.low, layout)})];
}

function draw_dots(plot, runs, {x, y}) {
  const steps = outputs.length <= kDotsUpTo ? runs.flat() : runs.filter((run) => run.length === 1).flat();
  const values = plot.low === plot.high ? [plot.high] : [plot.high, plot.low];
  return steps.flatMap((step) => values.map((value) =>
      svg("circle", {class: "dot", cx: x(step), cy: y(value(outputs[step])), r: 2})));
}

// A lossless output has no PSNR; its mark is at the top edge.
function draw_lossless(plot, {left, right, x}) {
  const steps = outputs.flatMap((output, step) => (plot.is_top(output) ? [step] : []));
  if (steps.length === 0) return [];
  const marks = steps.map((step) => svg("path", {class: "lossless", d: `M${x(step) - 5},${kTop - 9}h10l-5,8z`}));
  const first = x(steps[0]);
  const at_right = first > (left + right) / 2;
  const last = at_right ? first - 9 : x(steps.at(-1)) + 9;
  const fits = at_right || last < right - 60;
  const label = svg("text", {class: "lossless", x: fits ? last : first, y: fits ? kTop - 1 : kTop + 12,
                             "text-anchor": at_right ? "end" : "start"}, "lossless");
  return [...marks, label];
}

function summary_of(plot) {
  const shown = outputs.filter((output) => known(plot, output));
  const lossless = outputs.filter(plot.is_top).length;
  const unknown = outputs.length - shown.length - lossless;
  const texts = [`${plot.title} of ${outputs.length} steps`];
  if (shown.length > 0) {
    const [low, high] = [Math.min(...shown.map(plot.low)), Math.max(...shown.map(plot.high))];
    texts.push(`from ${format.number(low)} to ${format.number(high)}`);
  }
  if (lossless > 0) texts.push(`${lossless} lossless`);
  if (unknown > 0) texts.push(`${unknown} unknown`);
  return texts.join(", ");
}

function show_mark(plot) {
  const output = outputs[place];
  if (!output || plot.panel.hidden) return;
  const text = has_figure(plot, output) ? plot.text(output) : "unknown";
  set_text(plot.value, text);
  plot.drawing.setAttribute("aria-valuenow", String(place + 1));
  plot.drawing.setAttribute("aria-valuetext", `step ${place + 1}: ${text}`);
  const at = plot.layout.x(place);
  plot.mark.setAttribute("x1", at);
  plot.mark.setAttribute("x2", at);
}

function draw(plot) {
  const layout = plot.layout = layout_of(plot);
  const runs = runs_of(plot);
  plot.mark = svg("line", {class: "mark", y1: 0, y2: layout.bottom});
  plot.drawing.setAttribute("viewBox", `0 0 ${layout.width} ${kHeight}`);
  plot.drawing.setAttribute("aria-valuemax", String(outputs.length));
  plot.drawing.replaceChildren(...draw_axes(layout), plot.mark, ...runs.flatMap((run) => draw_run(plot, run, layout)),
                               ...draw_dots(plot, runs, layout), ...draw_lossless(plot, layout));
  set_text(plot.unit_text, layout.axis?.is_log ? `${plot.unit}, log scale` : plot.unit);
  set_text(plot.summary, summary_of(plot));
  show_mark(plot);
}

function go_by_key(event) {
  const last = outputs.length - 1;
  const steps = {ArrowLeft: place - 1, ArrowDown: place - 1, ArrowRight: place + 1, ArrowUp: place + 1, Home: 0, End: last,
                 PageDown: place - kPage, PageUp: place + kPage};
  if (!(event.key in steps) || event.altKey || event.ctrlKey || event.metaKey) return;
  event.preventDefault();
  go_to(Math.min(Math.max(steps[event.key], 0), last));
}

function go_by_pointer(plot, event) {
  if (event.buttons === 0) return;
  go_to(plot.layout.step_at(event.clientX - plot.drawing.getBoundingClientRect().left));
}

function make_drawing(plot) {
  const drawing = svg("svg", {class: "drawing", tabindex: 0, role: "slider", "aria-label": `${plot.title}, time step`,
                              "aria-describedby": `plot-${plot.name}-summary`, "aria-valuemin": 1});
  drawing.addEventListener("keydown", go_by_key);
  drawing.addEventListener("pointerdown", (event) => go_by_pointer(plot, event));
  drawing.addEventListener("pointermove", (event) => go_by_pointer(plot, event));
  return drawing;
}

function make_panel(plot) {
  plot.unit_text = element("span", "quiet");
  plot.value = element("output", "value");
  plot.summary = element("p", "unseen");
  plot.summary.id = `plot-${plot.name}-summary`;
  plot.drawing = make_drawing(plot);
  plot.panel = element("div", "plot", element("div", "heading", element("h3", "", plot.title), plot.unit_text, plot.value),
                       plot.drawing, plot.summary);
  plot.panel.id = `plot-${plot.name}`;
  return plot.panel;
}

/** Shows the figures of the series' outputs, one step for each output. */
export function show_plots(of_series) {
  outputs = of_series;
  for (const plot of kPlots) {
    plot.panel.hidden = outputs.filter((output) => has_figure(plot, output)).length < 2;
  }
  by_id("plots").hidden = kPlots.every((plot) => plot.panel.hidden);
  kPlots.filter((plot) => !plot.panel.hidden).forEach(draw);
}

/** Marks the step that is shown. */
export function mark_step(step) {
  place = step;
  kPlots.forEach(show_mark);
}

/** Sets up the plots. `when_chosen(step)` is called when a click or a key chooses a step. */
export function prepare_plots(when_chosen) {
  go_to = when_chosen;
  by_id("plots").replaceChildren(...kPlots.map(make_panel));
  let width = 0;
  new ResizeObserver(([{contentRect}]) => {
    if (contentRect.width === width || contentRect.width === 0) return;
    width = contentRect.width;
    show_plots(outputs);
  }).observe(by_id("plots"));
}
