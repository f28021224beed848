"use strict";
(() => {
  const VERDICTS = ["pass", "skipped", "deviation", "inconclusive", "fail", "error"];
  const SIGNS = ["✓", "–", "≈", "?", "✗", "!"];
  const ARROWS = [["→", "sent by the tester"], ["←", "received from the device"], ["⇢", "sent by a companion of the tester"]];
  const ROW_HEIGHT = 31;
  const $ = (id) => document.getElementById(id);
  const escaped = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&#39;" };
  const escape = (text) => String(text ?? "").replace(/[&<>"']/g, (it) => escaped[it]);
  const number = (value) => value.toLocaleString("en");

  // Light or dark: what the system says, unless the reader chose.
  const theme = $("theme");
  const dark = () => (document.documentElement.dataset.theme ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
  const keep = (value) => { try { if (value) localStorage.setItem("theme", value); return localStorage.getItem("theme"); } catch { return null; } };
  const name = () => { theme.textContent = dark() ? "Light" : "Dark"; };
  if (keep()) document.documentElement.dataset.theme = keep();
  theme.hidden = false;
  name();
  theme.addEventListener("click", () => { const value = dark() ? "light" : "dark"; document.documentElement.dataset.theme = value; keep(value); name(); });

  const unpack = async (id) => {
    const text = $(id).textContent;
    const bytes = Uint8Array.fromBase64 ? Uint8Array.fromBase64(text) : Uint8Array.from(atob(text), (it) => it.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Response(stream).json();
  };

  const duration = (ns) => {
    const [unit, name] = ns < 1e3 ? [1, "ns"] : ns < 1e6 ? [1e3, "µs"] : ns < 1e9 ? [1e6, "ms"] : [1e9, "s"];
    return ns === 0 ? "0" : `${Number((ns / unit).toPrecision(4))} ${name}`;
  };
  const badge = (verdict) => `<span class="badge ${VERDICTS[verdict]}"><span aria-hidden="true">${SIGNS[verdict]}</span> ${VERDICTS[verdict]}</span>`;
  const breakable = (id) => escape(id).replace(/[/.,]/g, "$&<wbr>").replace(/\[/g, "<wbr>[");

  const about = JSON.parse($("about").textContent);
  const list = $("list");
  const filter = $("filter");
  const groups = [];
  const cases = [];
  const pieces = new Map();

  const detailOf = async (index) => {
    let piece = 0;
    while (piece + 1 < about.firsts.length - 1 && about.firsts[piece + 1] <= index) piece += 1;
    if (!pieces.has(piece)) pieces.set(piece, unpack(`piece-${piece}`));
    return (await pieces.get(piece))[index - about.firsts[piece]];
  };

  const row = (it) => {
    const [name, title, verdict, microseconds, reason] = it.cells;
    const took = verdict === 1 ? "" : duration(microseconds * 1000);
    const why = reason ? `<i>${escape(reason)}</i>` : "";
    return `<details class="case ${VERDICTS[verdict]}" id="case-${it.index}"><summary>${badge(verdict)}<code>${breakable(name)}</code>`
      + `<span class="title">${escape(title)}${why}</span><span class="took">${took}</span></summary><div class="detail"></div></details>`;
  };

  const seconds = (ns) => (ns / 1e9).toFixed(6);
  const said = (at, words) => `<tr class="said"><td class="n">${at}</td><td></td><td></td><td colspan="2">${words}</td></tr>`;

  const limits = (min, max) => (min === null && max === null ? "" : min === null ? `, at most ${duration(max)}` : max === null ? `, at least ${duration(min)}` : `, ${duration(min)} to ${duration(max)}`);

  const line = (cells, at, steps) => {
    const [, kind, one, two, three, four, five, six] = cells;
    switch (kind) {
      case 0: {
        const [arrow, words] = ARROWS[two];
        return `<tr${five ? ' class="marked"' : ""}><td class="n">${at}</td><td>${escape(one)}</td><td><span title="${words}">${arrow}</span><span class="hidden">${words}</span></td>`
          + `<td><code>${escape(three)}</code></td><td>${escape(four)}</td></tr>`;
      }
      case 1: {
        const step = steps[one];
        const words = step ? `${step[1] ? "control" : "step"} ${one + 1}, line ${step[0]}\n<code class="code">${escape(step[2])}</code>` : `step ${one + 1}`;
        return `<tr class="step"><td class="n">${at}</td><td colspan="4">${words}</td></tr>`;
      }
      case 2: return said(at, `${escape(one)}: ${duration(two)}${three ? ` ± ${duration(three)}` : ""}${limits(four, five)} – ${VERDICTS[six]}`);
      case 3: return said(at, `observed ${escape(one)}: <strong>${escape(two)}</strong>`);
      case 4: return said(at, escape(one));
      case 5: return said(at, `stimulus: <strong>${escape(one)}</strong>`);
      case 6: return said(at, `bus error: ${escape(one)}`);
      case 7: return `<tr class="step"><td class="n">${at}</td><td colspan="4">what was changed is put back</td></tr>`;
      default: return said("", `… ${number(one)} frames left out; they are in the capture`);
    }
  };

  const exchange = (it) => {
    const steps = it.s ?? [];
    if (!it.t?.length) return "";
    let at = 0;
    const rows = it.t.map((cells) => { at += cells[0]; return line(cells, seconds(at), steps); });
    return `<div class="scroll" role="region" aria-label="exchange" tabindex="0"><table class="frames"><thead><tr><th scope="col">seconds</th><th scope="col">port</th>`
      + `<th scope="col"><span class="hidden">direction</span></th><th scope="col">bytes</th><th scope="col">meaning</th></tr></thead><tbody>${rows.join("")}</tbody></table></div>`;
  };

  const show = async (element) => {
    const index = Number(element.id.slice(5));
    const target = element.querySelector(".detail");
    if (target.childElementCount) return;
    const it = await detailOf(index);
    const say = (label, values) => (values?.length ? `<p><span class="label">${label}</span>${values.map(escape).join(" · ")}</p>` : "");
    const group = groups[cases[index].group];
    target.innerHTML = `<p><span class="label">case</span><code>${breakable(`${group.suite}/${cases[index].cells[0]}`)}</code> on ${escape(about.lanes[group.lane])}</p>`
      + say("follows", it.c) + say("against", it.a) + say("because", it.b ? [it.b] : []) + say("plays", it.x) + say("effects", it.e)
      + `<p><span class="label">written in</span><code>${escape(it.p)}</code></p>` + (it.f ?? "") + exchange(it);
  };

  const fill = (group) => {
    if (group.filled) return;
    group.filled = true;
    group.body.style.minHeight = "";
    group.body.innerHTML = group.shown.map((index) => row(cases[index])).join("");
  };

  const watcher = new IntersectionObserver((entries) => {
    for (const entry of entries) if (entry.isIntersecting) fill(groups[Number(entry.target.dataset.group)]);
  }, { rootMargin: "900px" });

  const apply = () => {
    const words = $("text").value.toLowerCase().split(/\s+/).filter(Boolean);
    const verdicts = new Set([...filter.querySelectorAll("[name=verdict]:checked")].map((it) => Number(it.value)));
    const device = $("device")?.value ?? "";
    let total = 0;
    for (const group of groups) {
      const here = device === "" || group.lane === Number(device);
      group.shown = here ? group.all.filter((index) => verdicts.has(cases[index].cells[2]) && words.every((word) => cases[index].words.includes(word))) : [];
      total += group.shown.length;
      group.element.hidden = group.shown.length === 0;
      group.many.textContent = group.shown.length === group.all.length ? number(group.all.length) : `${number(group.shown.length)} of ${number(group.all.length)}`;
      group.filled = false;
      group.body.textContent = "";
      group.body.style.minHeight = `${group.shown.length * ROW_HEIGHT}px`;
      watcher.unobserve(group.body);
      if (group.shown.length) watcher.observe(group.body);
    }
    $("shown").textContent = total === cases.length ? `all ${number(total)} shown` : `${number(total)} of ${number(cases.length)} shown`;
  };

  const reset = () => {
    $("text").value = "";
    if ($("device")) $("device").value = "";
    for (const box of filter.querySelectorAll("[name=verdict]")) box.checked = true;
    apply();
  };

  const open = async (index) => {
    const it = cases[index];
    if (!it) return;
    const group = groups[it.group];
    if (!group.shown.includes(index)) reset();
    fill(group);
    const element = $(`case-${index}`);
    element.open = true;
    await show(element);
    element.scrollIntoView({ block: "start" });
    element.querySelector("summary").focus({ preventScroll: true });
  };

  const follow = () => {
    const found = /^#case-(\d+)$/.exec(location.hash);
    if (found) open(Number(found[1]));
  };

  const next = () => {
    const here = document.activeElement?.closest?.(".case");
    const after = here ? Number(here.id.slice(5)) : -1;
    const found = cases.find((it) => it.index > after && it.cells[2] > 1 && groups[it.group].shown.includes(it.index));
    if (found) open(found.index);
  };

  const begin = async () => {
    for (const [lane, suite, title, rows] of await unpack("index")) {
      const at = groups.length;
      const element = document.createElement("section");
      element.className = "suite";
      const device = about.lanes.length > 1 ? ` <span>on ${escape(about.lanes[lane])}</span>` : "";
      element.innerHTML = `<h3><code>${breakable(suite)}</code><span>${escape(title)}</span>${device}<span class="count"></span></h3><div class="rows" data-group="${at}"></div>`;
      const all = rows.map((cells) => {
        const index = cases.length;
        cases.push({ index, group: at, cells, words: `${suite}/${cells[0]} ${cells[1]} ${cells[4]}`.toLowerCase() });
        return index;
      });
      groups.push({ lane, suite, element, all, shown: all, filled: false, body: element.lastElementChild, many: element.querySelector(".count") });
    }
    list.replaceChildren(...groups.map((group) => group.element));
    filter.hidden = false;
    apply();
    list.setAttribute("aria-busy", "false");
    performance.mark("ready");
    follow();
  };

  let pending = 0;
  filter.addEventListener("input", () => { cancelAnimationFrame(pending); pending = requestAnimationFrame(apply); });
  filter.addEventListener("submit", (event) => event.preventDefault());
  list.addEventListener("toggle", (event) => { if (event.target.open && event.target.matches(".case")) show(event.target); }, true);
  addEventListener("hashchange", follow);
  addEventListener("beforeprint", () => groups.forEach(fill));
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const writing = event.target.matches?.("input[type=search], select");
    if (event.key === "Escape" && !filter.hidden) { reset(); return; }
    if (writing) return;
    if (event.key === "/") { event.preventDefault(); $("text").focus(); }
    if (event.key === "n") next();
  });
  begin();
})();
