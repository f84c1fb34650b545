"use strict";
// Grades the numbers of a sheet of exercises in the page, without network.
const { questions, units } = JSON.parse(document.getElementById("questions").textContent);
const TOLERANCE = 0.005; // largest relative error, as for `symrot grade`
const NAMES = Object.keys(units).sort((a, b) => b.length - a.length);
const UNIT = new RegExp(`(/?)\\s*(${NAMES.join("|")})(?![A-Za-z])(?:\\^?\\(?(-?\\d+)\\)?)?`, "gy");

/**
 * Return {factor, dimension} of a text such as "kg m^2/s", or null if it is not a unit. A hertz is one per second, or
 * with `rotations` one rotation per second.
 */
function unitOf(text, rotations) {
  let plain = text.trim().replace(/\*\*/g, "^").replace(/[*·⋅()]/g, " ");
  plain = plain.replace(/^1\s*\//, "/").replace(/°/g, "deg");
  const divided = /\/\(/.test(text);
  let place = 0, factor = 1, below = false;
  const dimension = {};
  while (place < plain.length) {
    if (/\s/.test(plain[place])) { place += 1; continue; }
    UNIT.lastIndex = place;
    const match = UNIT.exec(plain);
    if (!match) return null;
    below = match[1] === "/" || (divided && below);
    const power = (below ? -1 : 1) * Number(match[3] ?? 1);
    const turn = rotations && match[2].endsWith("Hz") ? 2 * Math.PI : 1;
    factor *= (turn * units[match[2]].factor) ** power;
    for (const [name, value] of Object.entries(units[match[2]].dimension))
      dimension[name] = (dimension[name] ?? 0) + value * power;
    place = UNIT.lastIndex;
  }
  for (const name of Object.keys(dimension)) if (!dimension[name]) delete dimension[name];
  return { factor, dimension };
}

/** Return [value, rest of the text] of an arithmetic text such as "3/2*sqrt(2)", or null. */
function arithmetic(text) {
  let rest = text;
  const next = (pattern) => {
    const match = rest.match(pattern);
    if (match) rest = rest.slice(match[0].length);
    return match;
  };
  const atom = () => {
    let match = next(/^\s*(\d+(?:[.,]\d*)?|[.,]\d+)(?:(?:[eE]|\s*(?:\*|·|×|x)\s*10\s*(?:\^|\*\*))\s*\(?([+-]?\d+)\)?)?/);
    if (match) return Number(match[1].replace(",", ".")) * 10 ** Number(match[2] ?? 0);
    if (next(/^\s*(pi\b|π)/)) return Math.PI;
    match = next(/^\s*(sqrt|√)?\s*\(/);
    if (match) {
      const inside = sum();
      next(/^\s*\)/);
      return match[1] ? Math.sqrt(inside) : inside;
    }
    return NaN;
  };
  const power = () => { const base = atom(); return next(/^\s*(\^|\*\*)(?=\s*[\d.]+)/) ? base ** atom() : base; };
  const signed = () => (next(/^\s*[-−]/) ? -power() : (next(/^\s*\+/), power()));
  const product = () => {
    let value = signed();
    for (;;) {
      if (next(/^\s*[*·×](?=\s*([\d.(π√]|pi\b|sqrt))/)) value *= signed();
      else if (next(/^\s*\/(?=\s*([\d.(π√]|pi\b|sqrt))/)) value /= signed();
      else if (/^\s*(pi\b|[π√]|sqrt)/.test(rest)) value *= power(); // as in 14 pi
      else return value;
    }
  };
  const sum = () => {
    let value = product();
    for (;;) {
      if (next(/^\s*\+/)) value += product();
      else if (next(/^\s*[-−]/)) value -= product();
      else return value;
    }
  };
  const value = sum();
  return Number.isFinite(value) ? [value, rest] : null;
}

const near = (a, b) => Math.abs(a - b) <= TOLERANCE * (1 + 1e-9) * Math.abs(b) || Math.abs(a - b) < 1e-12;
const same = (a, b) => JSON.stringify(Object.entries(a).sort()) === JSON.stringify(Object.entries(b).sort());

/** Return half a unit of the last digit of a decimal such as "0.25", and the number of its digits; 0 for "1/4". */
function rounding(text, value) {
  const plain = text.trim().match(/^[-−+]?\s*(\d*[.,]?\d*)(?:(?:[eE]|\s*(?:\*|·|×|x)\s*10\s*(?:\^|\*\*))\s*\(?[+-]?\d+\)?)?$/);
  if (!plain || !value) return [0, 0];
  const digits = plain[1].replace(/[.,]/, "").replace(/^0+/, "").length || 1;
  return [0.5 * 10 ** (Math.floor(Math.log10(Math.abs(value))) - digits + 1), digits];
}

/** Return a text with powers such as s⁻² written as s^-2. */
function withoutSuperscripts(text) {
  const plain = (sign) => "+-0123456789"["⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(sign)];
  return text.replace(/[⁺⁻]?[⁰¹²³⁴-⁹]+/g, (power) => `^${[...power].map(plain).join("")}`);
}

const MULTIPLE = /^([-−]?)\s*((?:\d[\d.]*)?\s*[*·⋅/]?)\s*(\p{L}[\p{L}\p{M}\p{N}_'{}]*)\s*([*·⋅/]\s*\d[\d.]*)?((?:(?:\^|\*\*)\s*\d+)?)$/u;

/**
 * Return whether the text in front of "=" is a multiple or a power of one name, such as 2 I or 1/I, and not the name of
 * the asked quantity, a given quantity or a number with a unit.
 */
function isMultiple(left, question) {
  const match = left.trim().match(MULTIPLE);
  if (!match || question.given.includes(match[3]) || NAMES.includes(match[3])) return false;
  return Boolean(match[1] || match[2] || match[4] || (match[5] && !question.name.includes("^")));
}

/** Return [class, sentence] on an answer; of the two readings of 1,234 the better one counts. */
function grade(answer, question) {
  const text = withoutSuperscripts(answer);
  if (/[<>≠≤≥]|!=/.test(text) || isMultiple(text.split(/[=≈]/).slice(0, -1)[0] ?? "", question))
    return ["wrong", `Write the number alone, or after the name of the quantity and "=".`];
  const typed = text.replace(/^.*[=≈]/, "").trim().replace(/[.,;]+$/, "");
  const marks = [...new Set([typed, typed.replace(/(\d),(?=\d{3}(?!\d))/g, "$1")])].map((each) => mark(each, question));
  return marks.find(([kind]) => kind === "right") ?? marks.find(([kind]) => kind === "partial") ?? marks[0];
}

/** Return [class, sentence] on one reading of an answer. */
function mark(typed, question) {
  const number = arithmetic(typed);
  if (!number) return ["wrong", "This is not a number: write for example 0.125, 1.2e-3 or 3/8."];
  const [value, rest] = number;
  const name = rest.trim().replace(/^\[([^[\]]*)\]$|^\(([^()]*)\)$/, "$1$2");
  const unit = rest.trim() ? unitOf(name, /rad|rev|rpm|deg/.test(question.unit)) : null;
  if (rest.trim() && !unit) return ["wrong", `“${rest.trim()}” is not a unit that this page knows.`];
  const truth = Number(question.value);
  if (unit && !same(unit.dimension, question.dimension))
    return ["wrong", `The unit is wrong: the answer is ${question.unit ? `in ${question.unit}` : "a pure number"}.`];
  const angle = !unit && question.unit && !Object.keys(question.dimension).length;
  const scale = unit ? unit.factor / question.factor : 1, answer = value * scale;
  const [half, digits] = rounding(typed.slice(0, typed.length - rest.length), value);
  const rounds = Math.abs(answer - truth) <= half * scale * (1 + 1e-9);
  if (near(answer, truth) || (digits > 1 && rounds)) {
    if (!unit && Object.keys(question.dimension).length)
      return ["partial", `The number is right; write its unit, ${question.unit}.`];
    return ["right", "Right."];
  }
  const slip = question.slips.find(([number]) => near(answer, Number(number)));
  if (slip) return ["wrong", slip[1]];
  if (near(-answer, truth)) return ["wrong", "The size is right, but the sign is wrong."];
  if (angle && near((answer * Math.PI) / 180, truth * question.factor)) return ["wrong", "This is in degrees."];
  for (const factor of [2, 0.5, 4, 0.25])
    if (near(answer, factor * truth)) return ["wrong", `This is ${factor > 1 ? factor : `1/${1 / factor}`} times the answer.`];
  if (truth && near(answer, (truth * 180) / Math.PI)) return ["wrong", "This is in degrees, not in radians."];
  if (truth && near(answer, (truth * Math.PI) / 180)) return ["wrong", "This is in radians, not in degrees."];
  if (truth && near(answer, 1 / truth)) return ["wrong", "This is the reciprocal of the answer."];
  const power = truth && answer / truth > 0 ? Math.log10(answer / truth) : NaN;
  if (Math.abs(power - Math.round(power)) < 0.002 && Math.round(power))
    return ["wrong", "This is wrong by a power of ten: check how you converted the units."];
  if (rounds) return ["partial", "This is rounded too much: give at least three significant digits."];
  return ["wrong", "This is wrong. Try a hint."];
}

for (const form of document.querySelectorAll("form.numeric")) {
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const output = form.querySelector("output");
    const [kind, sentence] = grade(form.querySelector("input").value, questions[form.dataset.question]);
    output.className = kind;
    output.textContent = sentence;
  });
}
for (const hints of document.querySelectorAll(".hints")) {
  const all = [...hints.querySelectorAll(".hint")];
  all.slice(1).forEach((hint) => hint.classList.add("locked")); // each hint appears when the hint before it was opened
  all.forEach((hint, place) => hint.addEventListener("toggle", () => all[place + 1]?.classList.remove("locked")));
}
