//! Variables and operations of the scenes that the paper's systems are looked at by.

hoop! { guen::mechanical_system;
    scene Tilt { track theta; }
    scene Unit { track theta; fix a = 1, g = 9.81; provide energy; }
    scene Contact { track theta; provide reactions(eta4), linearization; }
}

sled! { guen::mechanical_system;
    scene Turn { track phi; }
    scene Centred { track phi; fix alpha = 0; }
    scene Level { fix incline = 0; }
    scene Straight { fix beta = 0; }
    scene Flat { fix incline = 0, beta = 0; }
}

appell! { guen::mechanical_system;
    scene Rolling { fix eta3; provide energy; }
}

#[test]
fn variables_and_operations() {
    println!("{}", hoop::levels());
    println!("{}", sled::levels());
    println!("{}", appell::levels());
    println!("{}", hoop::tilt::REPORT);
    println!("{}", hoop::contact::REPORT);
    println!("{}", appell::rolling::REPORT);
    assert_eq!(hoop::tilt::State::NAMES, ["theta", "eta1", "eta2", "eta3"]);
    assert_eq!(hoop::tilt::COST.total(), 14);
}
