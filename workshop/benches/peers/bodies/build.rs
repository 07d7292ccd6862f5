//! Writes the declarations of the robots. Each comes as a table, `NAME.robot` in the folder that `ROBOTS` names: a line for each
//! body, first the one that floats, with carrier, axis, place of the joint in the carrier, mass, moments and products of inertia
//! about the centre, place of the centre. All numbers but places of joints are constants of the declaration.

use std::fmt::Write;
use std::path::Path;
use std::{env, fs};

fn main() {
    let (tables, out) = (env::var("ROBOTS").expect("a folder"), env::var("OUT_DIR").expect("cargo sets it"));
    println!("cargo::rerun-if-env-changed=ROBOTS");
    for name in ["Quadruped", "Humanoid"] {
        let path = Path::new(&tables).join(name.to_lowercase()).with_extension("robot");
        println!("cargo::rerun-if-changed={}", path.display());
        let text = declaration(name, &fs::read_to_string(&path).expect("a table"));
        fs::write(Path::new(&out).join(name.to_lowercase()).with_extension("rs"), text)
            .expect("the output folder");
    }
}

fn declaration(name: &str, table: &str) -> String {
    const OF_A_BODY: [&str; 10] = ["m", "Ixx", "Iyy", "Izz", "Ixy", "Iyz", "Ixz", "cx", "cy", "cz"];
    let bodies: Vec<Vec<&str>> = table.lines().map(|line| line.split_whitespace().collect()).collect();
    let (mut constants, mut values, mut frames, mut inertias, mut rates) =
        <(String, String, String, String, String)>::default();
    let mut coordinates = String::from("x, y, z, yaw, pitch, roll");
    for (b, words) in bodies.iter().enumerate() {
        for (constant, value) in OF_A_BODY.iter().zip(&words[5..]) {
            let positive = if ["m", "Ixx", "Iyy", "Izz"].contains(constant) { " > 0" } else { "" };
            let _ = write!(constants, "{constant}{b}{positive}, ");
            let _ = write!(values, "{constant}{b}: {value}, ");
        }
        let [carrier, axis, x, y, z] = words[..5] else { panic!("a line of fifteen words") };
        if b > 0 {
            let _ = writeln!(frames, "let A{b} = A{carrier}*rot_{axis}(q{b});");
            let _ = writeln!(frames, "let p{b} = p{carrier} + A{carrier}*vec({x}, {y}, {z});");
            let _ = write!(coordinates, ", q{b}");
            let _ = write!(rates, "s{b} = dot(q{b}); ");
        }
        let _ = writeln!(
            inertias,
            "b{b} {{ mass: m{b}, inertia: sym(Ixx{b}, Iyy{b}, Izz{b}, Ixy{b}, Iyz{b}, Ixz{b}),
                center: p{b} + A{b}*vec(cx{b}, cy{b}, cz{b}), orientation: A{b} }}"
        );
    }
    let module = name.to_lowercase();
    format!(
        "guen::mechanical_system! {{
            pub system {name} {{
                constants {{ {constants} g = 9.81 }}
                coordinates {{ {coordinates} }}
                let A0 = rot_z(yaw)*rot_y(pitch)*rot_x(roll);
                let p0 = vec(x, y, z);
                {frames}
                bodies {{ {inertias} }}
                gravity = vec(0, 0, -g);
                parameters {{ v = transpose(A0)*dot(p0); w = angular_velocity_body(A0); {rates} }}
            }}
        }}
        pub type System = {module}::Prepared;
        pub fn prepared() -> System {{ {name} {{ {values} g: 9.81 }}.prepare().expect(\"a robot\") }}"
    )
}
