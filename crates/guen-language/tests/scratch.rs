use guen_language::{diagnostics::collect, model::resolve, parse::parse};
use guen_symbolic::Derivation;

fn show(source: &str) {
    let started = std::time::Instant::now();
    let (declaration, report) = parse(source.parse().unwrap());
    assert!(report.is_empty(), "{report}");
    let declaration = declaration.unwrap();
    let (model, report) = collect(|faults| resolve(&declaration, faults));
    assert!(report.is_empty(), "{report}");
    let mut model = model.unwrap();
    println!("resolve {:?}", started.elapsed());
    let mut d = Derivation::new(&mut model.bench, model.mechanics.clone()).unwrap_or_else(|e| match e {
        guen_symbolic::DerivationError::RoutesDisagree { equation } => panic!("routes {equation}"),
        e => panic!("{e:?}"),
    });
    println!("derive {:?} nodes {}", started.elapsed(), model.bench.graph.len());
    let n = d.system.forms.len();
    let l = d.system.forms.degrees;
    let names: Vec<String> =
        d.system.forms.coordinates.iter().map(|c| format!("d/d{}", model.bench.graph.text(*c))).collect();
    for j in 0..=n {
        let terms: Vec<_> =
            d.frame.operators.xi[j].iter().zip(&names).map(|(e, n)| (*e, n.as_str())).collect();
        println!("X{j} = {}", model.bench.graph.text_sum(&terms));
    }
    let names: Vec<String> = (1..=n).map(|t| format!("X{t}")).collect();
    for s in 1..=l {
        for r in 0..s {
            let terms: Vec<_> = (1..=n)
                .map(|t| (d.frame.brackets.coefficient(&mut model.bench, r, s, t), names[t - 1].as_str()))
                .collect();
            println!("(X{r},X{s}) = {}", model.bench.graph.text_sum(&terms));
        }
    }
    println!(
        "{:?} growth {:?} integrable {:?}",
        d.class,
        d.closure.growth,
        d.closure
            .integrable
            .iter()
            .map(|c| c
                .terms
                .iter()
                .map(|(v, f)| format!("{} eta{}", f.map_or("?".into(), |f| model.bench.graph.text(f)), v + 1))
                .collect::<Vec<_>>()
                .join(" + "))
            .collect::<Vec<_>>()
    );
    println!("scleronomic {} catastatic {} conservative {}", d.scleronomic, d.catastatic, d.conservative);
    for s in 0..l {
        let mut terms: Vec<_> = Vec::new();
        for t in 0..l {
            let p = model.bench.graph.mul(d.equations.mass[s][t], d.system.accelerations[t]);
            terms.push(p);
        }
        let f = model.bench.graph.neg(d.equations.forces[s]);
        terms.push(f);
        let e = model.bench.graph.sum(terms);
        println!("{} = 0", model.bench.graph.text(e));
    }
    println!("h = {}", model.bench.graph.text(d.energies.integral));
    for p in &d.energies.momenta {
        println!("p {}", model.bench.graph.text(*p));
    }
    for r in d.reactions.iter().flatten() {
        println!("lambda {}", model.bench.graph.text(*r));
    }
    println!(
        "chart {:?}",
        d.frame
            .operators
            .chart
            .iter()
            .chain(&d.solution.pivots)
            .map(|e| model.bench.graph.text(*e))
            .collect::<Vec<_>>()
    );
}

#[test]
fn hoop() {
    show("pub system Hoop {
        constants   { a > 0, A > 0, C > 0, g = 9.81 }
        coordinates { theta, psi, phi, xi, eta, zeta }
        let rolling = dot(psi)*cos(theta) + dot(phi);
        parameters { eta1 = dot(theta); eta2 = dot(psi)*sin(theta); eta3 = rolling; }
        constraints {
            eta4: dot(xi)   = a*sin(theta)*sin(psi)*dot(theta) - a*cos(theta)*cos(psi)*dot(psi) - a*cos(psi)*dot(phi);
            eta5: dot(eta)  + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
            eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
        }
        kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2) + 1/2*(A*eta1^2 + A*eta2^2 + C*eta3^2);
        force_function = -a*g*sin(theta);
    }");
}
#[test]
fn appell() {
    show(
        "pub system Appell {
        constants   { a > 0, A > 0, C > 0, g = 9.81 }
        coordinates { theta, psi, phi, xi, eta, zeta }
        parameters { eta1 = dot(theta); eta2 = dot(psi)*sin(theta); eta3 = dot(psi)*cos(theta) + dot(phi); }
        constraints {
            eta4: dot(xi) + a*sin(theta)*dot(theta) = 0;
            eta5: dot(eta) = 0;
            eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
        }
        kinetic_energy = 1/2*((A + a^2)*eta1^2 + A*eta2^2 + (C+a^2)*eta3^2);
        force_function = -a*g*sin(theta);
    }",
    );
}
#[test]
fn sled() {
    show(
        "pub system Sled {
        constants   { m > 0, alpha, beta, k > 0, incline, g = 9.81 }
        coordinates { phi, xi, eta }
        parameters { eta1 = dot(phi); eta2 = dot(xi)*cos(phi) + dot(eta)*sin(phi); }
        constraints { eta3: dot(xi)*sin(phi) - dot(eta)*cos(phi) = 0; }
        let x = xi + alpha*cos(phi) - beta*sin(phi);
        let y = eta + alpha*sin(phi) + beta*cos(phi);
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2) + m/2*k^2*dot(phi)^2;
        force_function = m*g*sin(incline)*x;
    }",
    );
}
