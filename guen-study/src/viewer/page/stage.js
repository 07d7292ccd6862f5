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
    const group = solid(body, PALETTE[i % PALETTE.length]);
    scene.add(group);
    return { body, group };
  });
  const links = motion.links.map((link, i) => {
    const colour = PALETTE[(motion.bodies.length + i) % PALETTE.length];
    const group = link.kind === "arrow" ? arrow([1, link.radius], colour) : rod(link.radius, colour);
    scene.add(group);
    return { link, group };
  });
  const paths = motion.paths.map((path, i) => makePath(scene, path, pathColour(i)));

  const camera = new THREE.PerspectiveCamera(38, 1, radius / 500, radius * 60);
  camera.up.copy(up);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableDamping = false;
  const followed = Math.max(0, motion.bodies.findIndex((body) => body.name === motion.follow));
  let following = false;
  const last = new THREE.Vector3();

  const focus = () => (following && movers[followed] ? movers[followed].group.position : center);
  function distance() {
    const narrow = Math.min(1, camera.aspect);
    const size = following ? Math.max(bodySize * 2.2, radius / 40) : radius;
    return (size * 0.84) / Math.sin((camera.fov * Math.PI) / 360) / narrow;
  }
  function look() {
    const from = motion.from ? new THREE.Vector3(...motion.from) : new THREE.Vector3(-0.75, -1.25, 0.8).applyQuaternion(level);
    controls.target.copy(focus());
    camera.position.copy(controls.target).addScaledVector(from.normalize(), distance());
    last.copy(controls.target);
    controls.update();
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
    for (const { link: { ends, times }, group } of links) {
      const at = locate(time, times);
      a.set(between(ends, 6, 0, at), between(ends, 6, 1, at), between(ends, 6, 2, at));
      b.set(between(ends, 6, 3, at), between(ends, 6, 4, at), between(ends, 6, 5, at)).sub(a);
      group.position.copy(a);
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

  let [width, height] = [0, 0];
  function draw() {
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    if (w !== width || h !== height) {
      const first = width === 0;
      [width, height] = [w, h];
      renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
      renderer.setSize(w, h, false);
      camera.aspect = w / Math.max(h, 1);
      camera.updateProjectionMatrix();
      if (first) look();
    }
    renderer.render(scene, camera);
  }

  function setFollowing(on) {
    following = on && movers.length > 0;
    look();
    return following;
  }

  return { place, draw, look, setFollowing, theme: ground.theme, controls, canFollow: movers.length > 0 };
}

const pathColour = (i) => [0xd55e00, 0x009e73, 0xcc79a7, 0x0072b2][i % 4];

/** A track: faint as a whole, strong up to the time that is shown. */
function makePath(scene, path, colour) {
  const whole = new THREE.BufferGeometry();
  whole.setAttribute("position", new THREE.BufferAttribute(path.points, 3));
  const faint = new THREE.Line(whole, new THREE.LineBasicMaterial({ color: colour, transparent: true, opacity: 0.28 }));
  const done = new THREE.BufferGeometry();
  done.setAttribute("position", new THREE.BufferAttribute(path.points.slice(), 3).setUsage(THREE.DynamicDrawUsage));
  const strong = new THREE.Line(done, new THREE.LineBasicMaterial({ color: colour }));
  faint.frustumCulled = false;
  strong.frustumCulled = false;
  scene.add(faint, strong);
  let moved = 0;
  return {
    until(time) {
      const at = locate(time, path.times);
      const { position } = done.attributes;
      // The vertex after the last whole sample stands where the point is; the one before goes back.
      position.array.set(path.points.subarray(3 * moved, 3 * moved + 3), 3 * moved);
      moved = at.k + 1;
      for (let i = 0; i < 3; i += 1) position.array[3 * moved + i] = between(path.points, 3, i, at);
      position.needsUpdate = true;
      done.setDrawRange(0, moved + 1);
    },
  };
}
