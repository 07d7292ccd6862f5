use super::{ArrayIndex, Arrays, Operand, Rolled, RolledStep, roll, simulate};
use crate::algebra::{ExprId, Graph, Role, SymbolId};
use crate::program::ProgramBuilder;
use crate::program::instruction::{Instruction, Operation, Programs, Value};
use crate::program::shape::Shape;

/// `x` in one array, `m` in another.
struct Given {
    names: Vec<String>,
}

impl Arrays for Given {
    fn symbol(&self, symbol: SymbolId) -> Option<ArrayIndex> {
        let (array, index) = self.names[symbol.index()].strip_suffix(']')?.split_once('[')?;
        Some((array.chars().next()?, index.parse().ok()?))
    }
}

/// A sweep outwards, one back, and a sum: what the elimination of a chain does.
fn sweeps(n: usize) -> (Graph, Given, Programs) {
    let mut g = Graph::new();
    g.nest_sums();
    let x: Vec<ExprId> = (0..n).map(|i| g.symbol(&format!("x[{i}]"), Role::Coordinate)).collect();
    let m: Vec<ExprId> = (0..n).map(|i| g.symbol(&format!("m[{i}]"), Role::Constant)).collect();
    let (mut pivots, mut right): (Vec<ExprId>, Vec<ExprId>) = Default::default();
    for i in 0..n {
        let (sine, cosine) = (g.sin(x[i]), g.cos(x[i]));
        let own = g.mul(m[i], sine);
        if i == 0 {
            pivots.push(g.keep(own));
            right.push(g.keep(cosine));
            continue;
        }
        let ratio = g.div(cosine, pivots[i - 1]);
        let (part, load) = (g.mul(ratio, cosine), g.mul(ratio, right[i - 1]));
        let (pivot, rest) = (g.sub(own, part), g.sub(x[i], load));
        pivots.push(g.keep(pivot));
        right.push(g.keep(rest));
    }
    let mut values = vec![g.zero(); n];
    for i in (0..n).rev() {
        let mut numerator = right[i];
        if i + 1 < n {
            let part = g.mul(m[i], values[i + 1]);
            numerator = g.sub(numerator, part);
        }
        let value = g.div(numerator, pivots[i]);
        values[i] = g.keep(value);
    }
    let total = g.sum(values.iter().copied());
    let outputs = [&values[..], &x[..], &[total]].concat();
    let mut builder = ProgramBuilder::new(&mut g);
    builder.add_function("sweeps", &outputs);
    let programs = builder.finish();
    let names = g.symbols().map(|symbol| g.symbol_info(symbol).name.clone()).collect();
    (g, Given { names }, programs)
}

fn code(programs: &Programs) -> (&[Instruction], &[Value], usize) {
    let function = &programs.functions[0];
    (&function.instructions, &function.outputs, function.values)
}

fn operate(operation: &Operation, operands: &[f64]) -> [f64; 2] {
    let value = match operation {
        Operation::Add(..) => operands[0] + operands[1],
        Operation::Sub(..) => operands[0] - operands[1],
        Operation::Mul(..) => operands[0] * operands[1],
        Operation::Div(..) => operands[0] / operands[1],
        Operation::Neg(_) => -operands[0],
        Operation::SinCos { .. } => return [operands[0].sin(), operands[0].cos()],
        Operation::Call(function, _) => match function.name() {
            "sin" => operands[0].sin(),
            "cos" => operands[0].cos(),
            other => panic!("{other}"),
        },
        other => panic!("{other:?}"),
    };
    [value, 0.0]
}

/// The results of straight-line code.
fn straight(
    (instructions, outputs, values): (&[Instruction], &[Value], usize),
    given: &dyn Fn(&Operation) -> f64,
) -> Vec<f64> {
    let mut known = vec![0.0; values];
    for Instruction { result, operation } in instructions {
        let operands: Vec<f64> = operation.operands().map(|v| known[v.index()]).collect();
        if operands.is_empty() {
            known[result.index()] = given(operation);
            continue;
        }
        let [first, second] = operate(operation, &operands);
        known[result.index()] = first;
        if let Operation::SinCos { cosine, .. } = operation {
            known[cosine.index()] = second;
        }
    }
    outputs.iter().map(|output| known[output.index()]).collect()
}

/// The results of code with loops.
fn looped(
    (instructions, outputs, values): (&[Instruction], &[Value], usize),
    rolled: &Rolled,
    given: &dyn Fn(&Operation) -> f64,
    element: &dyn Fn(char, usize) -> f64,
) -> Vec<f64> {
    let mut known = vec![f64::NAN; values];
    for Instruction { result, operation } in instructions {
        if matches!(operation, Operation::Symbol(_) | Operation::Prepared(_)) {
            known[result.index()] = given(operation);
        }
    }
    let mut arrays: Vec<Vec<f64>> = rolled.arrays.iter().map(|length| vec![f64::NAN; *length]).collect();
    let mut results = vec![None; outputs.len()];
    for step in &rolled.steps {
        match step {
            RolledStep::Once(Instruction { result, operation }) => {
                let operands: Vec<f64> = operation.operands().map(|v| known[v.index()]).collect();
                if operands.is_empty() {
                    known[result.index()] = given(operation);
                    continue;
                }
                let [first, second] = operate(operation, &operands);
                known[result.index()] = first;
                if let Operation::SinCos { cosine, .. } = operation {
                    known[cosine.index()] = second;
                }
            }
            RolledStep::Store { array, at, value } => arrays[*array][*at] = known[value.index()],
            RolledStep::Load { array, at, value } => known[value.index()] = arrays[*array][*at],
            RolledStep::Loop(turns) => {
                let mut order: Vec<i64> = (turns.from..turns.to).collect();
                if turns.descends {
                    order.reverse();
                }
                for turn in order {
                    let mut made: Vec<[f64; 2]> = Vec::new();
                    for line in &turns.lines {
                        let operands = line.operands.iter().map(|operand| match *operand {
                            Operand::Outside(value) => known[value.index()],
                            Operand::Given { array, first, stride } => {
                                element(array, (first as i64 + stride * (turn - turns.from)) as usize)
                            }
                            Operand::Line(line, second) => made[line][usize::from(second)],
                            Operand::Element(array, offset) => arrays[array][(turn + offset) as usize],
                        });
                        let operands: Vec<f64> = operands.collect();
                        let both = operate(&line.operation, &operands);
                        for ((value, store), output) in both.into_iter().zip(line.stores).zip(line.outputs) {
                            if let Some((array, offset)) = store {
                                arrays[array][(turn + offset) as usize] = value;
                            }
                            if let Some(run) = output {
                                results[run.at(turn) as usize] = Some(value);
                            }
                        }
                        made.push(both);
                    }
                }
            }
        }
    }
    results.into_iter().zip(outputs).map(|(result, output)| result.unwrap_or(known[output.index()])).collect()
}

#[test]
fn loops_compute_the_same_bits() {
    let (graph, arrays, programs) = sweeps(60);
    let code = code(&programs);
    let rolled = roll(code, (&graph, &arrays), &[]).expect("a regular family");
    let loops = rolled.steps.iter().filter(|step| matches!(step, RolledStep::Loop(_))).count();
    assert!((2..8).contains(&loops), "{loops}");
    assert!(rolled.size() < code.0.len() / 3, "{} of {}", rolled.size(), code.0.len());
    let element = |array: char, at: usize| match array {
        'x' => 0.3 + 0.01 * at as f64,
        'm' => 2.0 + 0.1 * ((7 * at) % 13) as f64,
        'k' => -0.7 + 0.2 * ((5 * at) % 11) as f64,
        other => panic!("{other}"),
    };
    let given = |operation: &Operation| match operation {
        Operation::Symbol(symbol) => {
            arrays.symbol(*symbol).map_or(f64::NAN, |(array, at)| element(array, at))
        }
        Operation::Number(value) => value.to_f64(),
        Operation::Prepared(k) => element('k', *k),
        other => panic!("{other:?}"),
    };
    let expected = straight(code, &given);
    let found = looped(code, &rolled, &given, &element);
    assert!(expected.iter().all(|value| value.is_finite()));
    let bits = |list: &[f64]| list.iter().map(|value| value.to_bits()).collect::<Vec<u64>>();
    assert_eq!(bits(&found), bits(&expected));
}

#[test]
fn loops_that_differ_anywhere_are_refused() {
    let (graph, arrays, programs) = sweeps(40);
    let code = code(&programs);
    let rolled = roll(code, (&graph, &arrays), &[]).expect("a regular family");
    assert!(simulate::is_equal(code, &rolled, &arrays));
    let mut damaged = 0;
    for place in 0..rolled.steps.len() {
        let mut variants: Vec<Rolled> = Vec::new();
        let mut missing = rolled.clone();
        missing.steps.remove(place);
        variants.push(missing);
        if let RolledStep::Loop(turns) = &rolled.steps[place] {
            let mut other = |change: &dyn Fn(&mut super::Loop)| {
                let mut copy = rolled.clone();
                let RolledStep::Loop(turns) = &mut copy.steps[place] else { return };
                change(turns);
                if copy != rolled {
                    variants.push(copy);
                }
            };
            other(&|turns| turns.to -= 1);
            other(&|turns| turns.from += 1);
            for line in 0..turns.lines.len() {
                other(&|turns| {
                    turns.lines[line].operation = match turns.lines[line].operation.clone() {
                        Operation::Add(a, b) => Operation::Sub(a, b),
                        Operation::Sub(a, b) => Operation::Add(a, b),
                        same => same,
                    }
                });
                other(&|turns| {
                    for operand in &mut turns.lines[line].operands {
                        match operand {
                            Operand::Given { first, .. } => *first += 1,
                            Operand::Element(_, offset) => *offset += 1,
                            _ => {}
                        }
                    }
                });
            }
        }
        for variant in variants {
            damaged += 1;
            assert!(!simulate::is_equal(code, &variant, &arrays), "step {place} of {}", rolled.steps.len());
        }
    }
    assert!(damaged > 40, "{damaged}");
}

#[test]
fn irregular_code_has_no_loops() {
    let mut g = Graph::new();
    let x: Vec<ExprId> = (0..40).map(|i| g.symbol(&format!("x[{i}]"), Role::Coordinate)).collect();
    let outputs: Vec<ExprId> = (0..40).map(|i| g.mul(x[i], x[(i * i + 7 * i) % 40])).collect();
    let mut builder = ProgramBuilder::new(&mut g);
    builder.add_function("pairs", &outputs);
    let programs = builder.finish();
    let names = g.symbols().map(|symbol| g.symbol_info(symbol).name.clone()).collect();
    assert!(roll(code(&programs), (&g, &Given { names }), &[]).is_none());
}

#[test]
fn shapes_tell_distances_of_indices_apart_and_not_indices() {
    let of = |index: i64| Shape { hash: 1, index: Some(index) };
    let pair = |a: i64, b: i64| Shape::joined(3, &mut [of(a), of(b)]).hash;
    assert_eq!(pair(3, 4), pair(8, 7));
    assert_ne!(pair(3, 4), pair(3, 5));
    assert_ne!(Shape::ordered(3, &[of(3), of(4)]).hash, Shape::ordered(3, &[of(4), of(3)]).hash);
}
