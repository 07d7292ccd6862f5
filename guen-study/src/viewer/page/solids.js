// Bodies as meshes. Everything round carries marks in a second tone, so that one sees it turn.

/** A colour in another tone, which wins over the plain one where both are drawn; `ink` gives the colour. */
const paint = (ink, tone = false) => {
  const material = new THREE.MeshStandardMaterial({ roughness: 0.55, metalness: 0.05, side: THREE.DoubleSide, polygonOffset: tone, polygonOffsetFactor: -4, polygonOffsetUnits: -4 });
  painted(() => {
    material.color.copy(ink());
    if (tone) material.color.offsetHSL(0, 0, otherTone(material.color));
  });
  return material;
};

/** The other tone: lighter on dark colours, darker on light ones. */
const otherTone = (colour) => (colour.getHSL({}).l > 0.5 ? -0.24 : 0.28);

function mesh(geometry, material) {
  const made = new THREE.Mesh(geometry, material);
  made.castShadow = true;
  made.receiveShadow = true;
  return made;
}

/** A hoop about z in twelve arcs, every third in the second tone. */
function ring([radius, thickness], ink) {
  const group = new THREE.Group();
  const tones = [paint(ink), paint(ink, true)];
  for (let k = 0; k < 12; k += 1) {
    const arc = new THREE.TorusGeometry(radius, thickness / 2, 16, 10, Math.PI / 6 + 1e-3);
    const part = mesh(arc, tones[k % 3 === 0 ? 1 : 0]);
    part.rotation.z = (k * Math.PI) / 6;
    group.add(part);
  }
  return group;
}

/** A cylinder about z. On its ends are four sectors and a hub; a long one has a stripe. */
function cylinder([radius, length], ink) {
  const group = new THREE.Group();
  const body = mesh(new THREE.CylinderGeometry(radius, radius, length, 48, 1), paint(ink));
  body.rotation.x = Math.PI / 2;
  group.add(body);
  const light = paint(ink, true);
  const lift = radius * 2e-3;
  for (const side of [1, -1]) {
    const z = side * (length / 2 + lift);
    for (const from of [0, Math.PI]) {
      const sector = mesh(new THREE.RingGeometry(radius * 0.18, radius * 0.82, 16, 1, from, Math.PI / 2), light);
      sector.position.z = z;
      group.add(sector);
    }
  }
  if (length > radius) {
    const stripe = mesh(new THREE.CylinderGeometry(radius * 1.004, radius * 1.004, length * 0.98, 8, 1, true, 0, 0.5), light);
    stripe.rotation.x = Math.PI / 2;
    group.add(stripe);
  }
  return group;
}

/** Several geometries as one, which is drawn at once. */
function merged(parts) {
  const geometry = new THREE.BufferGeometry();
  for (const name of ["position", "normal"]) {
    const all = parts.flatMap((part) => [...part.attributes[name].array]);
    geometry.setAttribute(name, new THREE.Float32BufferAttribute(all, 3));
  }
  let before = 0;
  const index = parts.flatMap((part) => {
    const moved = [...part.index.array].map((k) => k + before);
    before += part.attributes.position.count;
    return moved;
  });
  geometry.setIndex(index);
  return geometry;
}

// Edges of an octant: of many balls each is small.
const FINE = motion.bodies.length > 100 ? 5 : 14;
const balls = new Map();

/** The octants of a ball of one tone and of the other; one for all balls of a radius. */
function octants(radius) {
  if (!balls.has(radius)) {
    const octant = (i, j) => new THREE.SphereGeometry(radius, FINE, FINE, (i * Math.PI) / 2, Math.PI / 2, (j * Math.PI) / 2, Math.PI / 2);
    const ofTone = (tone) => merged([0, 1, 2, 3].map((i) => octant(i, (i + tone) % 2)));
    balls.set(radius, [ofTone(0), ofTone(1)]);
  }
  return balls.get(radius);
}

/** A ball of eight octants in two tones. */
function sphere([radius], ink) {
  const group = new THREE.Group();
  octants(radius).forEach((geometry, tone) => group.add(mesh(geometry, paint(ink, tone === 1))));
  return group;
}

/** A box with its edges drawn, and a face in the second tone where its own x points. */
function cuboid([a, b, c], ink) {
  const [plain, light] = [paint(ink), paint(ink, true)];
  const geometry = new THREE.BoxGeometry(a, b, c);
  const group = new THREE.Group();
  group.add(mesh(geometry, [light, plain, plain, plain, plain, plain]));
  const line = new THREE.LineBasicMaterial();
  painted(() => line.color.copy(ink()).offsetHSL(0, 0, -0.2));
  group.add(new THREE.LineSegments(new THREE.EdgesGeometry(geometry), line));
  return group;
}

/** An arrow of unit length along z, to be stretched; its parts are kept for that. */
function arrow([length, radius], ink) {
  const group = new THREE.Group();
  const material = paint(ink);
  const shaft = mesh(new THREE.CylinderGeometry(radius, radius, 1, 20), material);
  const head = mesh(new THREE.ConeGeometry(radius * 2.6, radius * 7, 24), material);
  shaft.rotation.x = Math.PI / 2;
  head.rotation.x = Math.PI / 2;
  group.add(shaft, head);
  group.userData.stretch = (full) => {
    const tip = Math.min(radius * 7, full * 0.6);
    const rest = Math.max(full - tip, 1e-9);
    shaft.scale.y = rest;
    shaft.position.z = rest / 2;
    head.scale.setScalar(Math.max(tip / (radius * 7), 1e-6));
    head.position.z = full - tip / 2;
    group.visible = full > 1e-9;
  };
  group.userData.stretch(length);
  return group;
}

/** A bar of unit length along z, to be stretched. */
function rod(radius, ink) {
  const group = new THREE.Group();
  const shaft = mesh(new THREE.CylinderGeometry(radius, radius, 1, 20), paint(ink));
  shaft.rotation.x = Math.PI / 2;
  shaft.position.z = 0.5;
  group.add(shaft);
  group.userData.stretch = (full) => group.scale.set(1, 1, Math.max(full, 1e-9));
  return group;
}

/** Makes a ghost of a solid: faint, and without a shadow. */
function fade(group) {
  group.traverse((part) => {
    if (!part.material) return;
    part.castShadow = false;
    for (const material of [part.material].flat()) Object.assign(material, { transparent: true, opacity: 0.38, depthWrite: false });
  });
}

const SOLIDS = { ring, cylinder, sphere, cuboid, arrow };

/** A body with all its shapes, in its own axes. */
function solid(body, slot) {
  const group = new THREE.Group();
  for (const shape of body.shapes) {
    const part = SOLIDS[shape.kind](shape.lengths, () => shade(shape.colour, slot));
    const [w, x, y, z] = shape.turn;
    part.position.set(...shape.place);
    part.quaternion.set(x, y, z, w);
    group.add(part);
  }
  return group;
}
