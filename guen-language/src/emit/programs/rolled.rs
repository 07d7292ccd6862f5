//! Code with loops as the text of Rust statements.

use std::fmt::Write;

use guen_symbolic::{Instruction, Loop, Operand, Operation, Rolled, RolledStep, Value};

use super::code::{Loads, apply, call, number};
use super::unpacked::indexed;

/// The body of a function: its statements, then its results as an array. Arrays of intermediate values are called `a0`, `a1`, .., values outside of loops
/// `v0`, `v1`, .., those of a turn `e0`, `e1`, .., and the results `o`.
pub(super) fn body(
    rolled: &Rolled,
    (instructions, outputs, values): (&[Instruction], &[Value], usize),
    loads: &dyn Loads,
) -> String {
    let mut text = String::new();
    let mut names = vec![String::new(); values];
    for Instruction { result, operation } in instructions {
        match operation {
            Operation::Symbol(symbol) => names[result.index()] = loads.symbol(*symbol),
            Operation::Prepared(k) => names[result.index()] = format!("k[{k}]"),
            _ if is_zero(operation) => names[result.index()] = "R::zero()".to_owned(),
            _ => names[result.index()] = format!("v{}", result.index()),
        }
        if let Operation::SinCos { cosine, .. } = operation {
            names[cosine.index()] = format!("v{}", cosine.index());
        }
    }
    let _ = write!(text, "let mut o = [R::zero(); {}];", outputs.len());
    for (index, length) in rolled.arrays.iter().enumerate() {
        let _ = write!(text, "let mut a{index} = [R::zero(); {length}];");
    }
    // The results are zero before anything is written.
    let zeros: Vec<Value> =
        instructions.iter().filter(|line| is_zero(&line.operation)).map(|line| line.result).collect();
    let mut written: Vec<bool> = outputs.iter().map(|output| zeros.contains(output)).collect();
    for step in &rolled.steps {
        match step {
            RolledStep::Once(Instruction { result, operation }) => {
                let operands: Vec<String> = operation.operands().map(|v| names[v.index()].clone()).collect();
                statement(&mut text, operation, &operands, &format!("v{}", result.index()), || {
                    second(operation).map(|v| format!("v{}", v.index())).unwrap_or_default()
                });
            }
            RolledStep::Store { array, at, value } => {
                let _ = write!(text, "a{array}[{at}] = {};", names[value.index()]);
            }
            RolledStep::Load { array, at, value } => {
                let _ = write!(text, "let v{} = a{array}[{at}];", value.index());
            }
            RolledStep::Loop(turns) => {
                for run in turns.lines.iter().flat_map(|line| line.outputs).flatten() {
                    for turn in turns.from..turns.to {
                        written[run.at(turn) as usize] = true;
                    }
                }
                turns_text(&mut text, turns, &names);
            }
        }
    }
    let mut place = 0;
    while place < outputs.len() {
        if written[place] {
            place += 1;
            continue;
        }
        let same = (place..outputs.len()).take_while(|next| {
            !written[*next]
                && is_run(&names[outputs[place].index()], &names[outputs[*next].index()], *next - place)
        });
        let length = same.count();
        let name = &names[outputs[place].index()];
        match indexed(name) {
            Some((array, first)) if length > 2 => {
                let _ = write!(
                    text,
                    "o[{place}..{}].copy_from_slice(&{array}[{first}..{}]);",
                    place + length,
                    first + length
                );
                place += length;
            }
            _ => {
                let _ = write!(text, "o[{place}] = {name};");
                place += 1;
            }
        }
    }
    text.push('o');
    text
}

fn is_zero(operation: &Operation) -> bool {
    matches!(operation, Operation::Number(number) if number.is_zero())
}

/// Whether a name is that of an element so far behind another one.
fn is_run(first: &str, name: &str, distance: usize) -> bool {
    let (Some((array, start)), Some((other, at))) = (indexed(first), indexed(name)) else { return false };
    array == other && at == start + distance
}

fn second(operation: &Operation) -> Option<Value> {
    match operation {
        Operation::SinCos { cosine, .. } => Some(*cosine),
        _ => None,
    }
}

/// Writes a statement of one operation.
fn statement(
    text: &mut String,
    operation: &Operation,
    operands: &[String],
    name: &str,
    second: impl FnOnce() -> String,
) {
    let expression = match operation {
        Operation::Add(..) => format!("{} + {}", operands[0], operands[1]),
        Operation::Sub(..) => format!("{} - {}", operands[0], operands[1]),
        Operation::Mul(..) => format!("{} * {}", operands[0], operands[1]),
        Operation::Div(..) => format!("{} / {}", operands[0], operands[1]),
        Operation::Neg(_) => format!("-{}", operands[0]),
        Operation::SinCos { .. } => {
            let _ = write!(text, "let ({name}, {}) = R::sin_cos({});", second(), operands[0]);
            return;
        }
        // Written out where it is used.
        _ if is_zero(operation) => return,
        Operation::Number(value) => number(value),
        Operation::Pi => "R::pi()".to_owned(),
        Operation::Call(function, _) => call(*function, &operands[0]),
        Operation::Apply(function, _) => apply(*function, operands),
        // They stand where they are used.
        Operation::Symbol(_) | Operation::Prepared(_) => return,
    };
    let _ = write!(text, "let {name} = {expression};");
}

/// Writes a loop; its counter `i` starts at zero.
fn turns_text(text: &mut String, turns: &Loop, names: &[String]) {
    let count = turns.to - turns.from;
    let (start, goes_on, next) = match turns.descends {
        true => (format!("{count}usize"), "i > 0".to_owned(), "i -= 1;"),
        false => ("0usize".to_owned(), format!("i < {count}"), ""),
    };
    let _ = write!(text, "let mut i = {start}; while {goes_on} {{ {next}");
    let element = |offset: i64| match turns.from + offset {
        0 => "i".to_owned(),
        offset if offset > 0 => format!("i + {offset}"),
        offset => format!("i - {}", -offset),
    };
    for (index, line) in turns.lines.iter().enumerate() {
        let operands: Vec<String> = line
            .operands
            .iter()
            .map(|operand| match *operand {
                Operand::Outside(value) => names[value.index()].clone(),
                Operand::Given { array, first, stride } => {
                    format!("{array}[{}]", place(first as i64, stride))
                }
                Operand::Line(line, false) => format!("e{line}"),
                Operand::Line(line, true) => format!("f{line}"),
                Operand::Element(array, offset) => format!("a{array}[{}]", element(offset)),
            })
            .collect();
        statement(text, &line.operation, &operands, &format!("e{index}"), || format!("f{index}"));
        for ((store, output), letter) in line.stores.iter().zip(line.outputs).zip(['e', 'f']) {
            if let Some((array, offset)) = store {
                let _ = write!(text, "a{array}[{}] = {letter}{index};", element(*offset));
            }
            if let Some(run) = output {
                let _ = write!(text, "o[{}] = {letter}{index};", place(run.at(turns.from), run.stride));
            }
        }
    }
    text.push_str(if turns.descends { "}" } else { "i += 1; }" });
}

/// The place of an element in the turn `i`, from that in the first turn and the distance of two turns.
fn place(first: i64, stride: i64) -> String {
    match (stride, first) {
        (0, first) => first.to_string(),
        (1, 0) => "i".to_owned(),
        (1, first) => format!("i + {first}"),
        (stride, first) if stride > 0 => format!("{stride} * i + {first}"),
        (stride, first) => format!("{first} - {} * i", -stride),
    }
}
