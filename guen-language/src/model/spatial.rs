//! Arithmetic of vectors and rotations.

use guen_symbolic::{ExprId, FrameId, Workbench};
use proc_macro2::Span;

use super::evaluate::{Evaluated, Evaluator};
use super::value::{Rotation, Turn, Value, Vector};
use crate::diagnostics::Fault;

impl Evaluator<'_> {
    pub(super) fn negated(&mut self, value: Value, span: Span) -> Evaluated {
        match value {
            Value::Scalar(e) => Ok(Value::Scalar(self.opposite(e))),
            Value::Vector(v) => Ok(Value::Vector(self.opposite_vector(&v))),
            other => self.fail(Fault::new(span, format!("{} has no negative", other.kind()))),
        }
    }

    /// `-e`.
    pub(super) fn opposite(&mut self, e: ExprId) -> ExprId {
        let minus = self.bench.graph.number(-1);
        self.scaled(minus, e)
    }

    /// `-v`.
    pub(super) fn opposite_vector(&mut self, v: &Vector) -> Vector {
        let minus = self.bench.graph.number(-1);
        self.scaled_vector(minus, v)
    }

    /// `a + b` of scalars.
    pub(super) fn sum(&mut self, a: ExprId, b: ExprId) -> ExprId {
        let sum = self.bench.graph.add(a, b);
        self.shapes.scalar_sum(&mut self.bench.graph, a, b, sum);
        sum
    }

    /// `a + b` of vectors.
    pub(super) fn vector_sum(&mut self, a: &Vector, b: &Vector) -> Vector {
        let sum = plus(&mut self.bench, a, b);
        self.shapes.added(&mut self.bench.graph, a, b, sum);
        sum
    }

    /// `a b`.
    fn scaled(&mut self, a: ExprId, b: ExprId) -> ExprId {
        let product = self.bench.graph.mul(a, b);
        self.shapes.scalar_product(&mut self.bench.graph, a, b, product);
        product
    }

    /// `a v`.
    pub(super) fn scaled_vector(&mut self, a: ExprId, v: &Vector) -> Vector {
        let product = v.map(|e| self.bench.graph.mul(a, e));
        self.shapes.scaled(&mut self.bench.graph, a, v, product);
        product
    }

    pub(super) fn multiplied(&mut self, a: Value, b: Value, span: Span) -> Evaluated {
        match (a, b) {
            (Value::Scalar(a), Value::Scalar(b)) => {
                let product = self.scaled(a, b);
                self.check_size(product, span)
            }
            (Value::Scalar(a), Value::Vector(v)) | (Value::Vector(v), Value::Scalar(a)) => {
                let product = self.scaled_vector(a, &v);
                self.checked_vector(product, span)
            }
            (Value::Rotation(r), Value::Vector(v)) => {
                let turned = apply(&mut self.bench, &r.matrix, &v);
                self.shapes.turned(&mut self.bench.graph, &r, &v, turned);
                self.checked_vector(turned, span)
            }
            (Value::Rotation(a), Value::Rotation(b)) => Ok(Value::Rotation(Box::new(self.composed(&a, &b)))),
            (Value::Vector(_), Value::Vector(_)) => self.fail(
                Fault::new(span, "a product of two vectors has two meanings")
                    .help("write `inner(u, v)` or `cross(u, v)`"),
            ),
            (Value::Vector(_), Value::Rotation(_)) => self.fail(
                Fault::new(span, "a rotation is applied from the left")
                    .help("write `R*v`, or `transpose(R)*v` for the inverse"),
            ),
            (a, b) => self.fail(Fault::new(span, format!("cannot multiply {} and {}", a.kind(), b.kind()))),
        }
    }

    pub(super) fn divided(&mut self, a: Value, b: Value, span: Span, divisor_span: Span) -> Evaluated {
        match (a, b) {
            (Value::Scalar(a), Value::Scalar(b)) => {
                self.check_divisor(b, divisor_span)?;
                let quotient = self.bench.graph.div(a, b);
                let inverse = self.bench.graph.powi(b, -1);
                self.shapes.scalar_product(&mut self.bench.graph, inverse, a, quotient);
                self.check_size(quotient, span)
            }
            (Value::Vector(v), Value::Scalar(b)) => {
                self.check_divisor(b, divisor_span)?;
                let quotient = v.map(|e| self.bench.graph.div(e, b));
                let inverse = self.bench.graph.powi(b, -1);
                self.shapes.scaled(&mut self.bench.graph, inverse, &v, quotient);
                self.checked_vector(quotient, span)
            }
            (a, b) => self.fail(Fault::new(span, format!("cannot divide {} by {}", a.kind(), b.kind()))),
        }
    }

    /// The rate of every component.
    pub(super) fn vector_rate(&mut self, v: &Vector) -> Vector {
        let rate = v.map(|e| self.total_rate(e));
        self.shapes.rate(&self.bench.graph, v, rate);
        rate
    }

    /// A rotation by an angle about a fixed unit axis.
    pub(super) fn turn(&mut self, axis: Vector, angle: ExprId) -> Rotation {
        let rate = self.total_rate(angle);
        let bench = &mut self.bench;
        let (s, c) = bench.graph.sin_cos(angle);
        let one = bench.graph.one();
        let rest = bench.graph.sub(one, c);
        // R = c 1 + (1 - c) a a^T + s [a]x
        let zero = bench.graph.zero();
        let minus: Vector = axis.map(|e| bench.graph.neg(e));
        let crossed = [[zero, minus[2], axis[1]], [axis[2], zero, minus[0]], [minus[1], axis[0], zero]];
        let matrix = std::array::from_fn(|i| {
            std::array::from_fn(|k| {
                let outer = bench.graph.product(&[(rest, 1), (axis[i], 1), (axis[k], 1)]);
                let turning = bench.graph.mul(s, crossed[i][k]);
                let diagonal = if i == k { c } else { zero };
                let sum = bench.graph.sum([diagonal, outer, turning]);
                bench.tidy(sum)
            })
        });
        let spin = axis.map(|e| bench.graph.mul(rate, e));
        let turns = Some(vec![Turn { axis, angle }]);
        let frame = self.shapes.turn(axis, angle);
        self.remembered(Rotation { matrix, world_rate: spin, body_rate: spin, frame, turns })
    }

    fn remembered(&mut self, rotation: Rotation) -> Rotation {
        self.shapes.rotation(&self.bench.graph, &rotation);
        rotation
    }

    /// The inverse rotation.
    pub(super) fn inverse(&mut self, r: &Rotation) -> Rotation {
        let frame = self.shapes.system.inverse(&mut self.bench.graph, r.frame);
        let inverse = inverse(&mut self.bench, r, frame);
        self.remembered(inverse)
    }

    /// `A B`, and the frame as it was written.
    fn composed(&mut self, a: &Rotation, b: &Rotation) -> Rotation {
        let frame = self.shapes.system.product(a.frame, b.frame);
        let product = Rotation { frame, ..self.joined_turns(a, b) };
        self.remembered(product)
    }

    /// `A B`. Turns about one axis that meet become one, `rot_z(a)*rot_z(b) = rot_z(a + b)`: nobody would compute sines
    /// and cosines of sums of angles from those of every joint.
    fn joined_turns(&mut self, a: &Rotation, b: &Rotation) -> Rotation {
        if let (Some(before), Some(after)) = (&a.turns, &b.turns)
            && let (Some((last, before)), Some((first, after))) = (before.split_last(), after.split_first())
            && let Some(angle) = self.joined(last, first)
        {
            let turned = self.turn(last.axis, angle);
            let (before, after) = (before.to_vec(), after.to_vec());
            let middle = if self.bench.graph.is_zero(angle) { None } else { Some(turned) };
            let parts = [self.chain(&before), middle, self.chain(&after)];
            let whole = parts.into_iter().flatten().reduce(|a, b| self.joined_turns(&a, &b));
            return whole.unwrap_or_else(|| self.turn(last.axis, angle));
        }
        compose(&mut self.bench, a, b)
    }

    /// The product of turns, the first on the left; `None` for no turn at all.
    fn chain(&mut self, turns: &[Turn]) -> Option<Rotation> {
        let mut product: Option<Rotation> = None;
        for turn in turns {
            let next = self.turn(turn.axis, turn.angle);
            product = Some(match product {
                None => next,
                Some(product) => compose(&mut self.bench, &product, &next),
            });
        }
        product
    }

    /// The angle of two turns about the same axis, or about opposite ones.
    fn joined(&mut self, a: &Turn, b: &Turn) -> Option<ExprId> {
        let graph = &mut self.bench.graph;
        let opposite = b.axis.map(|e| graph.neg(e));
        if a.axis == b.axis {
            Some(graph.add(a.angle, b.angle))
        } else if a.axis == opposite {
            Some(graph.sub(a.angle, b.angle))
        } else {
            None
        }
    }

    /// The homogeneous `v -> q v q*` of a quaternion, with the angular velocities `2 q' q*` and `2 q* q'`.
    pub(super) fn quaternion(&mut self, q: [ExprId; 4]) -> Rotation {
        let rates = q.map(|e| self.total_rate(e));
        let bench = &mut self.bench;
        let [w, x, y, z] = q;
        let matrix = {
            let mut square = |e| bench.graph.powi(e, 2);
            let (ww, xx, yy, zz) = (square(w), square(x), square(y), square(z));
            let mut twice = |a, b, c, d, minus: bool| {
                let (first, second) = (bench.graph.mul(a, b), bench.graph.mul(c, d));
                let sum = if minus { bench.graph.sub(first, second) } else { bench.graph.add(first, second) };
                bench.graph.scale(sum, &2.into())
            };
            let (xy_wz, xz_wy) = (twice(x, y, w, z, true), twice(x, z, w, y, false));
            let (xy_wz2, yz_wx) = (twice(x, y, w, z, false), twice(y, z, w, x, true));
            let (xz_wy2, yz_wx2) = (twice(x, z, w, y, true), twice(y, z, w, x, false));
            let mut diagonal = |plus: ExprId, first: ExprId, second: ExprId| {
                let kept = bench.graph.add(ww, plus);
                let lost = bench.graph.add(first, second);
                bench.graph.sub(kept, lost)
            };
            [
                [diagonal(xx, yy, zz), xy_wz, xz_wy],
                [xy_wz2, diagonal(yy, xx, zz), yz_wx],
                [xz_wy2, yz_wx2, diagonal(zz, xx, yy)],
            ]
        };
        // The vector part of 2 q' q* is 2 (w v' - w' v + v x v'), that of 2 q* q' has the cross product reversed.
        let v = [x, y, z];
        let [wd, xd, yd, zd] = rates;
        let vd = [xd, yd, zd];
        let turned = cross(bench, &v, &vd);
        let mut rate = |sign: bool| -> Vector {
            std::array::from_fn(|i| {
                let (gain, loss) = (bench.graph.mul(w, vd[i]), bench.graph.mul(wd, v[i]));
                let straight = bench.graph.sub(gain, loss);
                let sum = if sign {
                    bench.graph.add(straight, turned[i])
                } else {
                    bench.graph.sub(straight, turned[i])
                };
                bench.graph.scale(sum, &2.into())
            })
        };
        let (world_rate, body_rate) = (rate(true), rate(false));
        let frame = self
            .shapes
            .system
            .turned(FrameId::WORLD, guen_symbolic::Turn::General { matrix, spin: body_rate });
        self.remembered(Rotation { world_rate, body_rate, matrix, frame, turns: None })
    }
}

/// `inner(u, v)`.
pub(super) fn inner(bench: &mut Workbench, u: &Vector, v: &Vector) -> ExprId {
    bench.dot(u, v)
}

/// `cross(u, v)`.
pub(super) fn cross(bench: &mut Workbench, u: &Vector, v: &Vector) -> Vector {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (plus, minus) = (bench.graph.mul(u[j], v[k]), bench.graph.mul(u[k], v[j]));
        bench.graph.sub(plus, minus)
    })
}

/// `u + v`.
pub(super) fn plus(bench: &mut Workbench, u: &Vector, v: &Vector) -> Vector {
    std::array::from_fn(|i| bench.graph.add(u[i], v[i]))
}

/// `M v`.
pub(super) fn apply(bench: &mut Workbench, matrix: &[Vector; 3], v: &Vector) -> Vector {
    std::array::from_fn(|i| bench.dot(&matrix[i], v))
}

/// `M^T`.
pub(super) fn transposed(matrix: &[Vector; 3]) -> [Vector; 3] {
    std::array::from_fn(|i| std::array::from_fn(|k| matrix[k][i]))
}

/// The inverse rotation: the angular velocity of the world seen from the body.
fn inverse(bench: &mut Workbench, r: &Rotation, frame: FrameId) -> Rotation {
    Rotation {
        frame,
        matrix: transposed(&r.matrix),
        world_rate: r.body_rate.map(|e| bench.graph.neg(e)),
        body_rate: r.world_rate.map(|e| bench.graph.neg(e)),
        turns: r.turns.as_ref().map(|turns| {
            let back = |turn: &Turn| Turn { angle: bench.graph.neg(turn.angle), ..*turn };
            turns.iter().rev().map(back).collect()
        }),
    }
}

/// `A B`, with `omega = omega_A + A omega_B` in the world and `B^T omega_A + omega_B` in the body.
fn compose(bench: &mut Workbench, a: &Rotation, b: &Rotation) -> Rotation {
    let columns = transposed(&b.matrix);
    let matrix = std::array::from_fn(|i| {
        std::array::from_fn(|k| {
            let entry = bench.dot(&a.matrix[i], &columns[k]);
            bench.tidy(entry)
        })
    });
    let carried = apply(bench, &a.matrix, &b.world_rate);
    let pulled = apply(bench, &columns, &a.body_rate);
    Rotation {
        matrix,
        world_rate: plus(bench, &a.world_rate, &carried),
        body_rate: plus(bench, &pulled, &b.body_rate),
        frame: FrameId::WORLD,
        turns: a.turns.as_ref().zip(b.turns.as_ref()).map(|(a, b)| [&a[..], b].concat()),
    }
}
