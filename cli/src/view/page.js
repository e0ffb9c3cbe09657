// The page of `babybench view`: sends what people do, and shows the picture that comes back. All else happens in the program.

const $ = (id) => document.getElementById(id);
const canvas = $("picture");
const pen = canvas.getContext("2d");
const SPEEDS = [...$("speed").options].map((option) => option.value);
/** Response times, ms, above which pictures get coarser and below which they get finer. */
const SLOW = 55;
const QUICK = 25;
/** Colours of touch from weak to strong, and the force of the last colour, N. */
const HEAT = ["#8c175c", "#db294d", "#fa6b29", "#ffbf33", "#fff5b8"];
const STRONG = 10;

/** The visitor's actions since the last request. */
let words = [];
let turned = [0, 0];
let moved = [0, 0];
let zoomed = 1;
let dragged = null;
/** The program's last answer. */
let said = null;
let scale = 1;

function question() {
  const [wide, high] = [canvas.clientWidth, canvas.clientHeight];
  const fine = said?.paused ? 1 : scale;
  const lines = [`size ${Math.round(wide * fine)} ${Math.round(high * fine)}`, ...words];
  if (turned.some(Boolean)) lines.push(`turn ${turned.join(" ")}`);
  if (moved.some(Boolean)) lines.push(`shift ${moved.join(" ")}`);
  if (zoomed !== 1) lines.push(`zoom ${zoomed}`);
  if (dragged) lines.push(`drag ${dragged.join(" ")}`);
  [words, turned, moved, zoomed, dragged] = [[], [0, 0], [0, 0], 1, null];
  return lines.join("\n");
}

async function ask() {
  const started = performance.now();
  const answer = await fetch("frame", { method: "POST", body: question() });
  if (!answer.ok) throw new Error(await answer.text());
  const bytes = new Uint8Array(await answer.arrayBuffer());
  const end = bytes.indexOf(10);
  const next = JSON.parse(new TextDecoder().decode(bytes.subarray(0, end)));
  const picture = await createImageBitmap(new Blob([bytes.subarray(end + 1)], { type: "image/jpeg" }));
  const took = performance.now() - started;
  if (took > SLOW) scale = Math.max(0.35, scale * 0.9);
  else if (took < QUICK) scale = Math.min(1, scale * 1.03);
  show(next, picture);
  picture.close();
}

/** Requests one picture after another: less often while nothing moves, and not while the page is hidden. */
async function live() {
  for (;;) {
    await new Promise(requestAnimationFrame);
    try {
      await ask();
      $("tell").hidden = true;
      const still = () => said.paused && !words.length && !dragged && !turned.some(Boolean) && !moved.some(Boolean) && zoomed === 1;
      for (let k = 0; k < 10 && still(); k++) await new Promise((done) => setTimeout(done, 20));
    } catch (error) {
      const gone = error instanceof TypeError;
      $("tell").textContent = gone ? "The viewer has ended. Start it again, and open the address that it prints." : error.message;
      $("tell").hidden = false;
      await new Promise((done) => setTimeout(done, gone ? 1000 : 300));
    }
  }
}

function show(next, picture) {
  const dense = window.devicePixelRatio || 1;
  const [wide, high] = [canvas.clientWidth, canvas.clientHeight].map((side) => Math.round(side * dense));
  if (canvas.width !== wide || canvas.height !== high) [canvas.width, canvas.height] = [wide, high];
  pen.drawImage(picture, 0, 0, wide, high);
  const over = next.over;
  for (const [x, y, force] of over.touched ?? []) {
    const place = Math.min(1, Math.log(1 + 20 * force) / Math.log(1 + 20 * STRONG));
    pen.fillStyle = HEAT[Math.min(HEAT.length - 1, Math.floor(place * HEAT.length))];
    pen.beginPath();
    pen.arc(x * wide, y * high, (1.6 + 1.8 * place) * dense, 0, 7);
    pen.fill();
  }
  for (const ends of over.arrows ?? []) line(ends, "#ffd23c", "#5a4300");
  if (over.spring) {
    line(over.spring, "#3fcf76", "#0a4a24");
    pen.beginPath();
    pen.arc(over.spring[2] * wide, over.spring[3] * high, 5 * dense, 0, 7);
    pen.fillStyle = "#3fcf76";
    pen.fill();
  }
  function line([a, b, c, d], colour, edge) {
    for (const [style, width] of [[edge, 4], [colour, 2]]) {
      pen.strokeStyle = style;
      pen.lineWidth = width * dense;
      pen.lineCap = "round";
      pen.beginPath();
      pen.moveTo(a * wide, b * high);
      pen.lineTo(c * wide, d * high);
      pen.stroke();
    }
  }
  settle(next);
}

/** Updates the buttons to the program's state, which another page may have changed. */
function settle(next) {
  const first = !said;
  said = next;
  $("name").textContent = said.title;
  $("time").textContent = `${said.time.toFixed(2)} s${said.paused ? ", paused" : ""}`;
  $("pause").textContent = said.paused ? "Play" : "Pause";
  for (const id of ["moves", "touch", "contacts"]) $(id).setAttribute("aria-pressed", String(said[id]));
  $("touch").hidden = !said.feels;
  if (first) {
    document.title = `BabyBench: ${said.title}`;
    for (const name of said.cameras) $("camera").add(new Option(name, name));
  }
  const free = document.activeElement;
  if (free !== $("speed")) $("speed").value = SPEEDS.find((speed) => Number(speed) === said.speed) ?? "1";
  if (free !== $("camera")) $("camera").value = said.camera ?? "";
}

// --- buttons and keys ---

const flip = (id) => words.push(`${id} ${said?.[id] ? 0 : 1}`);
const actions = {
  pause: () => words.push(`pause ${said?.paused ? 0 : 1}`),
  step: () => words.push("step"),
  moves: () => flip("moves"),
  touch: () => flip("touch"),
  contacts: () => flip("contacts"),
  home: () => words.push("home"),
  reset: () => words.push("reset"),
};
for (const [id, act] of Object.entries(actions)) $(id).addEventListener("click", act);
$("speed").addEventListener("change", () => words.push(`speed ${$("speed").value}`));
$("camera").addEventListener("change", () => words.push(`camera ${$("camera").value}`));

function faster(by) {
  const at = SPEEDS.findIndex((speed) => Number(speed) === said?.speed);
  words.push(`speed ${SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, at + by))]}`);
}
const keys = {
  " ": actions.pause, ArrowRight: actions.step, ArrowUp: () => faster(1), ArrowDown: () => faster(-1), Home: actions.home,
  m: actions.moves, t: actions.touch, c: actions.contacts, r: actions.reset, "+": () => (zoomed *= 0.9), "-": () => (zoomed /= 0.9),
};
addEventListener("keydown", (event) => {
  const typing = event.target instanceof HTMLSelectElement || (event.target instanceof HTMLButtonElement && event.key === " ");
  const act = keys[event.key];
  if (!act || typing || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  act();
});

// --- the pointer ---

/** The last positions of the pointers that are down, by id. */
const down = new Map();
let pulls = false;

/** The place of an event in the picture, as fractions of its width and height. */
function place(event) {
  const box = canvas.getBoundingClientRect();
  return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
}

canvas.addEventListener("pointerdown", (event) => {
  canvas.setPointerCapture(event.pointerId);
  down.set(event.pointerId, [event.clientX, event.clientY]);
  if (down.size > 1 && pulls) words.push("release");
  pulls = down.size === 1 && event.button === 0 && !event.shiftKey && !said?.camera;
  if (pulls) words.push(`hold ${place(event).join(" ")}`);
});
canvas.addEventListener("pointermove", (event) => {
  const before = down.get(event.pointerId);
  if (!before) return;
  const [across, along] = [event.clientX - before[0], event.clientY - before[1]];
  const high = canvas.clientHeight;
  if (down.size === 2) {
    const other = [...down].find(([id]) => id !== event.pointerId)[1];
    const far = (x, y) => Math.hypot(x - other[0], y - other[1]);
    zoomed *= (far(...before) + 1) / (far(event.clientX, event.clientY) + 1);
    moved = [moved[0] + across / 2 / high, moved[1] + along / 2 / high];
  } else if (pulls && (said?.over.spring || words.some((word) => word.startsWith("hold")))) {
    dragged = place(event);
  } else if (event.shiftKey || event.buttons & 6) {
    moved = [moved[0] + across / high, moved[1] + along / high];
  } else {
    turned = [turned[0] + across * 0.4, turned[1] + along * 0.4];
  }
  down.set(event.pointerId, [event.clientX, event.clientY]);
});
for (const end of ["pointerup", "pointercancel"]) {
  canvas.addEventListener(end, (event) => {
    down.delete(event.pointerId);
    if (pulls) words.push("release");
    pulls = false;
    if (said?.over.spring) $("hint").classList.add("gone");
  });
}
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  zoomed *= Math.exp(Math.max(-60, Math.min(60, event.deltaY)) * 0.002);
}, { passive: false });
canvas.addEventListener("contextmenu", (event) => event.preventDefault());
setTimeout(() => $("hint").classList.add("gone"), 12000);
live();
