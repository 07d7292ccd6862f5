//! Functions of position drawn at random, with every elementary function of the language, finite for arguments of the order of one.

use super::draw::Draw;

/// A smooth function of two names; deeper ones have functions of functions.
pub fn function(draw: &mut Draw, names: [&str; 2], depth: usize) -> String {
    let mut argument = |name: &str| {
        if depth == 0 || draw.once_in(2) {
            return name.to_owned();
        }
        // Between -1 and 1, whatever is inside.
        format!("tanh({})", function(draw, names, depth - 1))
    };
    let (a, b) = (argument(names[0]), argument(names[1]));
    match draw.below(28) {
        0 => format!("sin({a})*{b}"),
        1 => format!("cos({a} + {b})"),
        2 => format!("tan({a}/4)"),
        3 => format!("cot(3/2 + {a}/8)"),
        4 => format!("exp({a}/3 - {b}/5)"),
        5 => format!("ln(9 + {a})"),
        6 => format!("sqrt(9 + {a} - {b}/2)"),
        7 => format!("sinh({a}/2)"),
        8 => format!("cosh({b}/2)*{a}"),
        9 => format!("tanh({a}*{b})"),
        10 => format!("atan({a} - 2*{b})"),
        11 => format!("asin({a}/9)"),
        12 => format!("acos({b}/9)"),
        13 => format!("atan2({a}, 2 + {b}^2)"),
        14 => format!("atan2(-1 - {b}^2, {a})"),
        15 => format!("abs({a} - 9)"),
        // Continuous, and so is its first derivative.
        16 => format!("sign({a} - 1)*({a} - 1)^2*{b}"),
        17 => format!("(9 + {a})^(1/3)"),
        18 => format!("(9 + {b})^(3/2)/27"),
        19 => format!("(2 + {a}^2)^-2"),
        20 => format!("{a}.sin()*({b}).powi(3)"),
        21 => format!("-{a}^2/(3 - {b}/3)"),
        26 => format!("inner(vec({a}, 1, {b}), unit(vec(1, {b}, 2)))"),
        22 => format!("max({a}, {b}, 1/3)"),
        23 => format!("min({a} + {b}/2, 1 - {b})*{b}"),
        24 => format!("clamp({a}, -1/2, 1/2 + {b}^2)"),
        // Continuous, and so is its first derivative.
        25 => format!("select({a} {} {b}, ({a} - {b})^2, ({b} - {a})^3)", draw.pick(&[">=", "<=", ">", "<"])),
        _ => format!("norm(cross(vec({a}, 3, 0), vec({b}, 1, 2)))"),
    }
}
