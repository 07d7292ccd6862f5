//! Constants, states and inputs in files.

guen::mechanical_system! {
    pub system Cart {
        constants { m > 0, r#type, g = 9.81 }
        inputs { force }
        coordinates { x }
        parameters { speed = dot(x); }
        kinetic_energy = m/2*speed^2;
        forces { force - r#type*g*speed along speed; }
    }
}

guen::mechanical_system! {
    /// Without constants and inputs.
    pub system Free {
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = v^2/2;
    }
}

#[test]
fn records_go_there_and_back() {
    let constants = Cart { m: 2.0, r#type: 0.25, g: 9.81 };
    let text = serde_json::to_string(&constants).unwrap();
    assert_eq!(text, r#"{"m":2.0,"type":0.25,"g":9.81}"#);
    assert_eq!(serde_json::from_str::<Cart>(&text).unwrap(), constants);
    let state = cart::State { x: 0.1, speed: -3.0 };
    let text = serde_json::to_string(&state).unwrap();
    assert_eq!(text, r#"{"x":0.1,"speed":-3.0}"#);
    assert_eq!(serde_json::from_str::<cart::State>(r#"{"speed":-3.0,"x":0.1}"#).unwrap(), state);
    assert_eq!(serde_json::from_str::<cart::State>("[0.1, -3]").unwrap(), state);
    assert_eq!(
        serde_json::from_str::<cart::Inputs<f32>>(r#"{"force":1}"#).unwrap(),
        cart::Inputs { force: 1.0 }
    );
    assert_eq!(serde_json::from_str::<Free>("{}").unwrap(), Free::default());
}

/// The feature `float_roundtrip` of `serde_json`, which `guen-study` turns on, and `docs/control.md` asks for.
#[test]
fn every_bit_comes_back() {
    let mut bits = 1_u64;
    for _ in 0..100_000 {
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let x = f64::from_bits(bits ^ bits >> 29);
        if x.is_finite() {
            let text = serde_json::to_string(&cart::State { x, speed: -x }).unwrap();
            let back: cart::State = serde_json::from_str(&text).unwrap();
            assert_eq!([back.x, back.speed].map(f64::to_bits), [x, -x].map(f64::to_bits));
        }
    }
    // JSON has no infinities: `serde_json` writes `null`, which is no number.
    let text = serde_json::to_string(&cart::State { x: f64::INFINITY, speed: 0.0 }).unwrap();
    assert!(serde_json::from_str::<cart::State>(&text).is_err(), "{text}");
}

#[test]
fn what_is_missing_unknown_or_twice_is_refused() {
    let error = |text: &str| serde_json::from_str::<cart::State>(text).unwrap_err().to_string();
    assert!(error(r#"{"x":0.1}"#).contains("missing field `speed`"));
    assert!(error(r#"{"x":0.1,"v":1}"#).contains("unknown field `v`, expected `x` or `speed`"));
    assert!(error(r#"{"x":0.1,"x":1,"speed":2}"#).contains("duplicate field `x`"));
    assert!(error("[1]").contains("invalid length 1"));
}

/// A name that a type parameter of serde's traits has by custom.
mod short_names {
    guen::mechanical_system! {
        pub system Short {
            constants { a = 1 }
            coordinates { q }
            parameters { v = dot(q); }
            kinetic_energy = a*v^2/2;
            scene D { fix a = 2; }
        }
    }

    #[test]
    fn are_free_for_scenes() {
        assert!(short::D::try_from(Short { a: 2.0 }).is_ok());
    }
}

mod entries_that_scenes_leave {
    guen::mechanical_system! {
        /// A scene has one entry of an array alone, beside a constant that follows another.
        pub system Row {
            constants { a = 1, e[2] = 45, c = a, k > 0 = 1 }
            coordinates { q }
            kinetic_energy = k/2*dot(q)^2;
            potential_energy = (e[0] + c*e[1])*q;
            scene One { fix e[1] = 3; }
        }
    }

    #[test]
    fn go_there_and_back() {
        for c in [guen::Derived::Follows, guen::Derived::Set(7.0)] {
            let constants = row::One { a: 2.0, e_0: 5.0, c, ..Default::default() };
            let text = serde_json::to_string(&constants).unwrap();
            assert_eq!(serde_json::from_str::<row::One>(&text).unwrap(), constants, "{text}");
        }
        let text = serde_json::to_string(&row::One { c: 7.0.into(), ..Default::default() }).unwrap();
        assert_eq!(text, r#"{"a":1.0,"c":7.0,"k":1.0,"e_0":45.0}"#);
    }
}
