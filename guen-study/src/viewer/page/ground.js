// What the bodies move on: a plane with a grid whose squares have a round length, or a surface.

/** 1, 2 or 5 times a power of ten, not above a length. */
function roundLength(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return [5, 2, 1].find((digit) => digit * power <= length) * power;
}

function makeGround(scene, { up, center, radius, least, most }) {
  const materials = [];
  const painted = (light, dark, make) => {
    const material = make();
    materials.push({ material, light, dark });
    return material;
  };
  const surfaceMaterial = () =>
    painted(0xe3e7ea, 0x2a3037, () => new THREE.MeshStandardMaterial({ roughness: 0.95, side: THREE.DoubleSide }));
  const lineMaterial = () =>
    painted(0xb3bcc5, 0x4a545f, () => new THREE.LineBasicMaterial({ transparent: true, opacity: 0.8 }));

  function plane(point, normal) {
    const half = radius * 1.5;
    const square = roundLength(half / 5);
    const count = Math.ceil(half / square);
    const group = new THREE.Group();
    const size = 2 * count * square;
    const floor = new THREE.Mesh(new THREE.PlaneGeometry(size, size), surfaceMaterial());
    floor.receiveShadow = true;
    // Below the lines, and below what touches it.
    floor.position.z = -radius * 6e-4;
    const points = [];
    for (let k = -count; k <= count; k += 1) {
      points.push(k * square, -size / 2, 0, k * square, size / 2, 0, -size / 2, k * square, 0, size / 2, k * square, 0);
    }
    const lines = new THREE.BufferGeometry();
    lines.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
    const grid = new THREE.LineSegments(lines, lineMaterial());
    grid.position.z = -radius * 3e-4;
    group.add(floor, grid);
    const direction = new THREE.Vector3(...normal).normalize();
    group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), direction);
    // Below the middle of the motion, on whole squares of the plane.
    const base = new THREE.Vector3(...point);
    const local = center.clone().sub(base).applyQuaternion(group.quaternion.clone().invert());
    const snapped = new THREE.Vector3(Math.round(local.x / square) * square, Math.round(local.y / square) * square, 0);
    group.position.copy(base).add(snapped.applyQuaternion(group.quaternion));
    scene.add(group);
    return square;
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
    const made = new THREE.Mesh(geometry, surfaceMaterial());
    made.receiveShadow = true;
    const grid = new THREE.BufferGeometry();
    grid.setAttribute("position", new THREE.Float32BufferAttribute(lines, 3));
    made.position.copy(up).multiplyScalar(-radius * 6e-4);
    scene.add(made, new THREE.LineSegments(grid, lineMaterial()));
  }

  let square = null;
  for (const ground of motion.grounds) {
    if (ground.kind === "plane") square = plane(ground.point, ground.normal);
    else surface(ground);
  }
  if (motion.grounds.length === 0 && !motion.bare) square = plane([0, 0, 0], motion.up);
  motion.square = square;

  return {
    theme(dark) {
      for (const { material, light, dark: night } of materials) material.color.set(dark ? night : light);
    },
  };
}
