// The space: light, ground, bodies, paths, and the eye.

function makeStage() {
  const canvas = document.getElementById("space");
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
  renderer.shadowMap.enabled = true;
  const scene = new THREE.Scene();
  const up = new THREE.Vector3(...motion.up).normalize();
  const { least, most } = box();
  const center = least.clone().add(most).multiplyScalar(0.5);
  const reaches = motion.bodies.flatMap((body) => body.shapes.map(reach));
  const bodySize = Math.max(0, ...reaches);
  const radius = Math.max(most.distanceTo(least) / 2 + bodySize, 1e-9);

  scene.add(new THREE.HemisphereLight(0xffffff, 0x8a8f96, 1.9));
  const sun = new THREE.DirectionalLight(0xffffff, 2.2);
  sun.castShadow = true;
  sun.shadow.mapSize.set(2048, 2048);
  scene.add(sun, sun.target);
  const side = new THREE.Vector3(0.35, -0.55, 0.9);
  const level = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), up);
  side.applyQuaternion(level).normalize();

  const ground = makeGround(scene, { up, center, radius, least, most });

  const movers = motion.bodies.map((body, i) => {
    const group = solid(body, slots.body(i));
    if (isGhost(body)) fade(group);
    scene.add(group);
    return { body, group, size: Math.max(radius / 60, ...body.shapes.map(reach)) };
  });
  const links = motion.links.map((link, i) => {
    const ink = () => solidInk(slots.link(i));
    const group = link.kind === "arrow" ? arrow([1, link.radius], ink) : rod(link.radius, ink);
    const holder = new THREE.Group();
    if (isGhost(link)) fade(group);
    holder.add(group);
    scene.add(holder);
    return { link, group, holder, middle: new THREE.Vector3() };
  });
  const paths = motion.paths.map((path, i) => makePath(scene, path, () => solidInk(slots.path(i))));

  const camera = new THREE.PerspectiveCamera(38, 1, radius / 500, radius * 60);
  camera.up.copy(up);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableDamping = false;
  let followed = Math.max(0, motion.bodies.findIndex((body) => body.plain === motion.follow));
  let following = false;
  const last = new THREE.Vector3();

  const focus = () => (following && movers[followed] ? movers[followed].group.position : center);
  /** How far the eye is from something of this size that fills the picture. */
  const away = (size) => (size * 0.84) / Math.sin((camera.fov * Math.PI) / 360) / Math.min(1, camera.aspect);
  const directions = {
    first: firstDirection,
    above: () => new THREE.Vector3(0, -1e-3, 1).applyQuaternion(level),
    front: () => new THREE.Vector3(0, -1, 0).applyQuaternion(level),
    side: () => new THREE.Vector3(1, 0, 0).applyQuaternion(level),
    below: () => new THREE.Vector3(-0.5, -0.8, -0.6).applyQuaternion(level),
  };
  function lookFrom(direction, target, distance) {
    if (direction.lengthSq() === 0) direction = directions.first();
    controls.target.copy(target);
    camera.position.copy(target).addScaledVector(direction.normalize(), distance);
    last.copy(target);
    controls.update();
  }
  /** The view with this name. */
  function lookAt(name) {
    lookFrom(directions[name](), focus(), away(following ? Math.max(bodySize * 2.2, radius / 40) : radius));
  }
  /** Everything, from where the eye looks. */
  function fit() {
    lookFrom(camera.position.clone().sub(controls.target), center, away(radius));
  }
  /** Turns the view by angles about the upward direction and towards it. */
  function turn(about, towards) {
    const offset = camera.position.clone().sub(controls.target);
    offset.applyQuaternion(new THREE.Quaternion().setFromAxisAngle(up, about));
    const angle = offset.angleTo(up);
    const to = Math.min(Math.max(angle - towards, 1e-3), Math.PI - 1e-3);
    const axis = new THREE.Vector3().crossVectors(up, offset).normalize();
    offset.applyQuaternion(new THREE.Quaternion().setFromAxisAngle(axis, to - angle));
    camera.position.copy(controls.target).add(offset);
    controls.update();
  }
  /** Comes nearer or goes farther. */
  function zoom(factor) {
    const offset = camera.position.clone().sub(controls.target);
    const distance = Math.min(Math.max(offset.length() * factor, controls.minDistance), controls.maxDistance);
    camera.position.copy(controls.target).addScaledVector(offset.normalize(), distance);
    controls.update();
  }
  /** Limits: nobody gets lost far away, inside of a body, or beside everything. */
  function bound() {
    controls.minDistance = Math.min(bodySize > 0 ? bodySize : radius / 100, radius);
    controls.maxDistance = 8 * away(radius);
    const strayed = controls.target.clone().sub(center);
    const over = strayed.length() - 2 * radius;
    if (over > 0) {
      strayed.setLength(over);
      controls.target.sub(strayed);
      camera.position.sub(strayed);
    }
    const offset = camera.position.clone().sub(controls.target);
    const distance = Math.min(Math.max(offset.length(), controls.minDistance), controls.maxDistance);
    camera.position.copy(controls.target).addScaledVector(offset.normalize(), distance);
    camera.near = distance / 100;
    camera.far = distance + 8 * radius;
    camera.updateProjectionMatrix();
  }

  const [a, b] = [new THREE.Vector3(), new THREE.Vector3()];
  const [p, q] = [new THREE.Quaternion(), new THREE.Quaternion()];
  const zAxis = new THREE.Vector3(0, 0, 1);
  /** Puts everything where it is at a time. */
  function place(time) {
    for (const { body: { poses, times }, group } of movers) {
      const at = locate(time, times);
      group.position.set(between(poses, 7, 0, at), between(poses, 7, 1, at), between(poses, 7, 2, at));
      p.fromArray(poses, 7 * at.k + 3);
      q.fromArray(poses, 7 * at.k + 10);
      group.quaternion.slerpQuaternions(p, q, at.part);
    }
    for (const { link: { ends, times }, group, middle } of links) {
      const at = locate(time, times);
      a.set(between(ends, 6, 0, at), between(ends, 6, 1, at), between(ends, 6, 2, at));
      b.set(between(ends, 6, 3, at), between(ends, 6, 4, at), between(ends, 6, 5, at)).sub(a);
      group.position.copy(a);
      middle.copy(a).addScaledVector(b, 0.5);
      const length = b.length();
      if (length > 0) group.quaternion.setFromUnitVectors(zAxis, b.divideScalar(length));
      group.userData.stretch(length);
    }
    for (const path of paths) path.until(time);
    if (following) {
      a.copy(focus()).sub(last);
      camera.position.add(a);
      controls.target.add(a);
      last.add(a);
      controls.update();
    }
    // Shadows are sharp where the bodies are.
    const lit = following || radius > bodySize * 12 ? Math.max(bodySize * 5, radius / 40) : radius * 1.3;
    const aim = movers.length ? movers[followed].group.position : center;
    const middle = lit < radius * 1.3 ? aim : center;
    sun.target.position.copy(middle);
    sun.position.copy(middle).addScaledVector(side, lit * 3);
    const eye = sun.shadow.camera;
    if (eye.right !== lit) {
      [eye.left, eye.right, eye.top, eye.bottom, eye.near, eye.far] = [-lit, lit, lit, -lit, lit * 0.5, lit * 6];
      eye.updateProjectionMatrix();
      sun.shadow.normalBias = lit / 500;
    }
  }

  let waiting = null;
  /** Where the eye is, and where it looks. */
  const eye = () => [...camera.position.toArray(), ...controls.target.toArray()];
  /** Looks from there to there; from the first picture on. */
  function setEye(from) {
    if (!opened) waiting = from;
    camera.position.fromArray(from);
    controls.target.fromArray(from, 3);
    controls.update();
  }

  let [width, height, opened] = [0, 0, false];
  const quality = makeQuality();
  let drawn = quality.next(false);
  function draw(playing) {
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    if (w === 0 || h === 0) return;
    const wanted = quality.next(playing);
    if (w !== width || h !== height || wanted !== drawn) {
      const first = !opened;
      [width, height, drawn] = [w, h, wanted];
      renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2) * wanted.part);
      renderer.setSize(w, h, false);
      sun.castShadow = wanted.shadows;
      camera.aspect = w / h;
      opened = true;
      if (first) lookAt("first");
      if (first && waiting) setEye(waiting);
    }
    bound();
    renderer.render(scene, camera);
  }

  /** The picture as it is, drawn anew for paper: light, and with its own sides. */
  function print(paper) {
    const unseen = width <= 0;
    const [w, h] = unseen ? [800, 500] : [width, height];
    if (unseen) {
      camera.aspect = w / h;
      camera.updateProjectionMatrix();
      lookAt("first");
      bound();
    }
    renderer.setPixelRatio(1600 / w);
    sun.castShadow = true;
    renderer.setSize(w, h, false);
    renderer.render(scene, camera);
    [paper.width, paper.height] = [canvas.width, canvas.height];
    paper.getContext("2d").drawImage(canvas, 0, 0);
    [width, height] = [-1, -1];
  }

  function setFollowing(on, which = followed) {
    followed = which;
    following = on && movers.length > 0;
    const direction = camera.position.clone().sub(controls.target);
    lookFrom(direction, focus(), away(following ? Math.max(bodySize * 2.2, radius / 40) : radius));
    return following;
  }

  /** Where a point of space is in the picture, in pixels from its left upper corner; `null` behind the eye. */
  function onScreen(point) {
    const seen = point.clone().project(camera);
    return seen.z < 1 ? [((seen.x + 1) / 2) * width, ((1 - seen.y) / 2) * height] : null;
  }
  /** The number of the body under a pixel, of several the smallest one; -1 if there is none. */
  function bodyAt(x, y) {
    const ray = new THREE.Vector3((2 * x) / width - 1, 1 - (2 * y) / height, 0.5).unproject(camera).sub(camera.position).normalize();
    let [found, least] = [-1, Infinity];
    movers.forEach(({ group, size }, i) => {
      const to = group.position.clone().sub(camera.position);
      const along = to.dot(ray);
      if (group.visible && along > 0 && size < least && to.addScaledVector(ray, -along).length() < size) [found, least] = [i, size];
    });
    return found;
  }

  /** Where a body is at the two samples around a time, and their times. */
  function around(i, time, before, after) {
    const { poses, times } = motion.bodies[i];
    const at = locate(time, times);
    [before, after].forEach((point, next) => {
      const from = { k: at.k, part: next };
      point.set(...[0, 1, 2].map((n) => between(poses, 7, n, from)));
    });
    return [times[at.k], times[at.k + 1]];
  }

  const shown = { body: (i, on) => (movers[i].group.visible = on), link: (i, on) => (links[i].holder.visible = on), path: (i, on) => paths[i].show(on) };
  return {
    place, draw, print, around, look: lookAt, fit, turn, zoom, eye, setEye, followed: () => followed, setFollowing, onScreen, bodyAt, shown, ground, controls, camera, movers, links,
    radius, center, canFollow: movers.length > 0,
  };
}

/** The number of a thing, or of the one in the first run that has its name. */
const ofTwin = (kind, i) => (motion[kind][i].like >= 0 ? motion[kind][i].like : i);

/** Numbers in the list of colours: bodies first, what links points, then paths, so that none has the colour of a body. */
const slots = {
  body: (i) => ofTwin("bodies", i),
  link: (i) => motion.own.bodies + ofTwin("links", i),
  path: (i) => {
    const before = motion.own.bodies + motion.own.links;
    // Where the hues have just begun again, the first path would have the first body's.
    return before + (before > 0 && before % INKS.length === 0 ? 1 : 0) + ofTwin("paths", i);
  },
};

/** A track: faint as a whole, strong up to the time that is shown. */
function makePath(scene, path, ink) {
  const whole = new THREE.BufferGeometry();
  whole.setAttribute("position", new THREE.BufferAttribute(path.points, 3));
  const faint = new THREE.Line(whole, new THREE.LineBasicMaterial({ transparent: true, opacity: isGhost(path) ? 0.25 : 0.4 }));
  const done = new THREE.BufferGeometry();
  done.setAttribute("position", new THREE.BufferAttribute(path.points.slice(), 3).setUsage(THREE.DynamicDrawUsage));
  const strong = new THREE.Line(done, new THREE.LineBasicMaterial(isGhost(path) ? { transparent: true, opacity: 0.55 } : {}));
  painted(() => [faint, strong].forEach((line) => line.material.color.copy(ink())));
  faint.frustumCulled = false;
  strong.frustumCulled = false;
  scene.add(faint, strong);
  let moved = 0;
  return {
    show(on) {
      faint.visible = on;
      strong.visible = on;
    },
    until(time) {
      if (!strong.visible) return;
      const at = locate(time, path.times);
      const { position } = done.attributes;
      // The vertex after the last whole sample stands where the point is; the one before goes back.
      const before = moved;
      position.array.set(path.points.subarray(3 * moved, 3 * moved + 3), 3 * moved);
      moved = at.k + 1;
      for (let i = 0; i < 3; i += 1) position.array[3 * moved + i] = between(path.points, 3, i, at);
      // Nothing else has changed: of a million points this takes no time.
      position.addUpdateRange(3 * before, 3);
      position.addUpdateRange(3 * moved, 3);
      position.needsUpdate = true;
      done.setDrawRange(0, moved + 1);
    },
  };
}
