//! Faults in the arguments of a macro of the program and in its body are told once each, and nothing that follows from them.

macro_rules! pendulum {
    ($name:ident, $length:ident, $force:expr, $($count:tt)*) => {
        guen::mechanical_system! {
            pub system $name {
                $($count)*
                constants { m: kg > 0, $length: m > 0, g: m/s^2 = 9.81 }
                coordinates { phi: rad }
                parameters { w = dot(phi); }
                kinetic_energy = m/2*$length^2*w^2 + $length;
                potential_energy = -m*g*$length*cos(phj);
                forces { $force along w; }
                outputs { angle = phi; }
            }
        }
    };
}

// A name in an argument and one in the body; a sum of two dimensions in the body.
pendulum!(One, length, m*g*missing,);
// A statement that is an argument, with a name of which nothing more is told.
pendulum!(Two, length, m*g*many, count many = ;);
// A fault at a brace of an argument: nothing is told of the function that it should have declared.
pendulum!(Four, length, h(m*g*length), fn h(a) { a });
// A sum of two dimensions in an argument.
pendulum!(Three, length, m*g*length + m,);

fn main() {}
