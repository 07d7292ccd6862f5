// What the bodies move on: a plane with a grid whose squares have a round length, or a surface.

/** 1, 2 or 5 times a power of ten, not above a length. */
function roundLength(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return [5, 2, 1].find((digit) => digit * power <= length) * power;
}

// Sides of a surface, as the drawing library numbers them.
const [FRONT, BACK] = [0, 1];

/** How many of the moving points lie below a plane, farther than a part of the motion's size; `on` is a point of it. */
function isBelow(on, normal, least, most, radius) {
  const lowest = [0, 1, 2].reduce((sum, i) => sum + normal.getComponent(i) * ((normal.getComponent(i) > 0 ? least : most).getComponent(i) - on.getComponent(i)), 0);
  return lowest < -0.02 * radius;
}

function makeGround(scene, { up, center, radius, least, most }) {
  const all = new THREE.Group();
  scene.add(all);
  const material = (make, light, dark) => {
    const made = make();
    painted(() => made.color.set(look.dark ? dark : light));
    return made;
  };
  /** One side of a surface: see-through from behind, and in front where something moves behind it. */
  function face(geometry, side, seeThrough) {
    const glass = seeThrough ? { transparent: true, opacity: side === BACK ? 0.16 : 0.45, depthWrite: false } : {};
    const made = new THREE.Mesh(geometry, material(() => new THREE.MeshStandardMaterial({ roughness: 0.95, side, ...glass }), 0xe3e7ea, 0x2a3037));
    made.receiveShadow = side === FRONT;
    return made;
  }
  const lineMaterial = () => material(() => new THREE.LineBasicMaterial({ transparent: true, opacity: 0.8 }), 0xb3bcc5, 0x4a545f);

  function plane(point, normal) {
    const half = radius * 1.5;
    const square = roundLength(half / 5);
    const count = Math.ceil(half / square);
    const group = new THREE.Group();
    const size = 2 * count * square;
    const direction = new THREE.Vector3(...normal).normalize();
    const base = new THREE.Vector3(...point);
    const glass = isBelow(base, direction, least, most, radius);
    const geometry = new THREE.PlaneGeometry(size, size);
    const sides = [face(geometry, FRONT, glass), face(geometry, BACK, true)];
    // Below the lines, and below what touches it.
    for (const floor of sides) floor.position.z = -radius * 6e-4;
    const points = [];
    for (let k = -count; k <= count; k += 1) {
      points.push(k * square, -size / 2, 0, k * square, size / 2, 0, -size / 2, k * square, 0, size / 2, k * square, 0);
    }
    const lines = new THREE.BufferGeometry();
    lines.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
    const grid = new THREE.LineSegments(lines, lineMaterial());
    grid.position.z = -radius * 3e-4;
    group.add(...sides, grid);
    group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), direction);
    // Below the middle of the motion, on whole squares of the plane.
    const local = center.clone().sub(base).applyQuaternion(group.quaternion.clone().invert());
    const snapped = new THREE.Vector3(Math.round(local.x / square) * square, Math.round(local.y / square) * square, 0);
    group.position.copy(base).add(snapped.applyQuaternion(group.quaternion));
    all.add(group);
    return { square, glass };
  }

  function surface({ x, y, mesh: count, heights }) {
    const geometry = new THREE.PlaneGeometry(1, 1, count - 1, count - 1);
    const { position } = geometry.attributes;
    const lines = [];
    const at = (i, j) => [x[0] + ((x[1] - x[0]) * i) / (count - 1), y[0] + ((y[1] - y[0]) * j) / (count - 1), heights[j * count + i]];
    for (let j = 0; j < count; j += 1) {
      // Rows of the geometry go downwards in y.
      for (let i = 0; i < count; i += 1) position.setXYZ((count - 1 - j) * count + i, ...at(i, j));
    }
    for (let j = 0; j < count; j += 4) {
      for (let i = 0; i + 1 < count; i += 1) lines.push(...at(i, j), ...at(i + 1, j), ...at(j, i), ...at(j, i + 1));
    }
    geometry.computeVertexNormals();
    const made = new THREE.Group();
    made.add(face(geometry, FRONT, false), face(geometry, BACK, true));
    const grid = new THREE.BufferGeometry();
    grid.setAttribute("position", new THREE.Float32BufferAttribute(lines, 3));
    made.position.copy(up).multiplyScalar(-radius * 6e-4);
    all.add(made, new THREE.LineSegments(grid, lineMaterial()));
  }

  let found = null;
  for (const ground of motion.grounds) {
    if (ground.kind === "plane") found = plane(ground.point, ground.normal);
    else surface(ground);
  }
  // A scene without a ground of its own stands on the level one, unless it goes below it: then there is none.
  const level = new THREE.Vector3(0, 0, 0);
  const stands = motion.grounds.length === 0 && !motion.bare && !isBelow(level, up, least, most, radius);
  if (stands) found = plane([0, 0, 0], motion.up);
  motion.square = found?.square ?? null;
  // For programs that test the page.
  motion.ground = { shown: all.children.length > 0, glass: found?.glass ?? false };

  return {
    has: all.children.length > 0,
    show(on) {
      all.visible = on;
    },
  };
}
