"use strict";
// Pictures in turn run by style alone. Where scripts run as well, they get a button and a slider, and follow a pointer that is drawn across.
document.querySelectorAll("svg").forEach((svg) => {
  const pictures = [...svg.querySelectorAll(".turn")], last = pictures.length - 1;
  if (last < 1) return;
  const make = (name, properties) => Object.assign(document.createElement(name), properties);
  const bar = make("div", { className: "bar" });
  const button = make("button", { type: "button" }), slider = make("input", { type: "range", min: 0, max: last, ariaLabel: "Picture" });
  bar.append(button, slider);
  svg.after(bar);
  svg.classList.add("held");
  let now = last, timer = 0;
  const show = (k) => {
    now = k;
    slider.value = k;
    pictures.forEach((picture, i) => picture.classList.toggle("now", i === k));
  };
  const run = (runs) => {
    clearInterval(timer);
    timer = runs ? setInterval(() => (now < last ? show(now + 1) : run(false)), 1000 * svg.querySelector("[data-pace]").dataset.pace) : 0;
    button.textContent = runs ? "❚❚" : "▶";
    button.ariaLabel = runs ? "Pause" : "Play";
  };
  button.addEventListener("click", () => {
    if (!timer && now === last) show(0);
    run(!timer);
  });
  slider.addEventListener("input", () => { run(false); show(Number(slider.value)); });
  svg.addEventListener("pointermove", (e) => {
    if (e.buttons !== 1) return;
    const box = svg.getBoundingClientRect();
    run(false);
    show(Math.round(last * Math.max(0, Math.min(1, (e.clientX - box.left) / box.width))));
  });
  show(last);
  run(false);
});
