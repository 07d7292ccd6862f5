//! Constants, states and inputs in files; with the feature `serde` alone.
#![cfg(feature = "serde")]

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

#[test]
fn what_is_missing_unknown_or_twice_is_refused() {
    let error = |text: &str| serde_json::from_str::<cart::State>(text).unwrap_err().to_string();
    assert!(error(r#"{"x":0.1}"#).contains("missing field `speed`"));
    assert!(error(r#"{"x":0.1,"v":1}"#).contains("unknown field `v`, expected `x` or `speed`"));
    assert!(error(r#"{"x":0.1,"x":1,"speed":2}"#).contains("duplicate field `x`"));
    assert!(error("[1]").contains("invalid length 1"));
}
