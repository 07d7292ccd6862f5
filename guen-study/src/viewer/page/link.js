// A link to what is seen: time, camera, the part of the time, the body that is followed, behind the `#` of the address.

function makeLink({ stage, player, span, setFollowing, isFollowing }) {
  const digits = (numbers) => numbers.map((number) => Number(number.toPrecision(9))).join(",");
  function write() {
    const said = [`t=${motion.start + player.state.time}`];
    if (stage) said.push(`camera=${digits(stage.eye())}`);
    if (stage && isFollowing()) said.push(`follow=${stage.followed()}`);
    if (!span.isWhole) said.push(`part=${[span.from, span.to].map((time) => motion.start + time).join(",")}`);
    return `#${said.join("&")}`;
  }
  /** Shows what the address says; what it does not say, or says wrongly, stays. */
  function read() {
    const said = new URLSearchParams(location.hash.slice(1));
    const numbers = (name, count) => {
      const found = (said.get(name) ?? "").split(",").map((text) => (text.trim() === "" ? NaN : Number(text)));
      return found.length === count && found.every(Number.isFinite) ? found : null;
    };
    const part = numbers("part", 2);
    if (part && part[1] > part[0]) span.set(...part.map((time) => time - motion.start));
    const time = numbers("t", 1);
    if (time) player.setTime(time[0] - motion.start);
    const camera = stage && numbers("camera", 6);
    if (!camera) return false;
    stage.place(player.state.time);
    const body = numbers("follow", 1);
    setFollowing(Boolean(body && stage.movers[body[0]]), body?.[0]);
    stage.setEye(camera);
    document.getElementById("view").value = "own";
    return true;
  }
  document.getElementById("link").addEventListener("click", () => {
    try {
      history.replaceState(null, "", write());
    } catch {
      location.hash = write();
    }
    const copied = navigator.clipboard?.writeText(location.href);
    const words = "The address of this page leads to this time and view";
    if (copied) copied.then(() => tell(`${words}; it is copied.`), () => tell(`${words}.`));
    else tell(`${words}.`);
  });
  window.addEventListener("hashchange", read);
  return { read };
}

/** The menu of what can be saved, and the list of keys. */
function makeMenu() {
  const [button, menu, help] = ["more", "menu", "help"].map((id) => document.getElementById(id));
  const show = (on) => {
    menu.hidden = !on;
    button.setAttribute("aria-expanded", String(on));
  };
  button.addEventListener("click", () => {
    show(menu.hidden);
    if (!menu.hidden) menu.querySelector("button").focus();
  });
  document.addEventListener("pointerdown", (event) => {
    if (!menu.contains(event.target) && !button.contains(event.target)) show(false);
  });
  for (const entry of menu.querySelectorAll("button")) entry.addEventListener("click", () => show(false));
  document.getElementById("list-keys").addEventListener("click", () => help.showModal());
  return {
    /** Closes it; whether it was open. */
    close() {
      if (menu.hidden) return false;
      show(false);
      button.focus();
      return true;
    },
  };
}
