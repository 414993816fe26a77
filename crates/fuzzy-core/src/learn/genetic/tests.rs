//! The search as a whole, with every operator.

use super::*;

fn shares(population: usize, crossover: f64, mutation: f64) -> GeneticSettings {
    GeneticSettings::with_shares(population, crossover, mutation).unwrap()
}

fn sphere(x: &[f64]) -> f64 {
    x.iter().map(|v| (v - 0.3) * (v - 0.3)).sum()
}

fn tell(search: &mut Genetic, fitness: impl Fn(&[f64]) -> f64) {
    let fitness: Vec<f64> = search.ask().map(fitness).collect();
    search.tell(&fitness).unwrap();
}

/// Every operator with every other, on a chromosome of all kinds.
fn searches() -> impl Iterator<Item = Genetic> {
    let selections = [Selection::Pairs, Selection::Neighbours, Selection::Tournament(3)];
    let crossovers = [
        Crossover::OnePoint,
        Crossover::Uniform,
        Crossover::average(0.5),
        Crossover::Average { low: -1.0, high: 2.0 },
        Crossover::blx(0.5),
        Crossover::SimulatedBinary { eta: 2.0 },
    ];
    let mutations = [
        Mutation::None,
        Mutation::Gaussian { rate: 0.5, scale: 0.7 },
        Mutation::Polynomial { rate: 0.5, eta: 3.0 },
        Mutation::Redraw { rate: 0.5 },
    ];
    let genes = [
        Gene::Real { low: -1.0, high: 2.0 },
        Gene::Bit,
        Gene::Integer { low: -3, high: 4 },
        Gene::Bit,
        Gene::Real { low: 0.7, high: 0.7 },
    ];
    let all = selections.into_iter().flat_map(move |selection| {
        crossovers.into_iter().flat_map(move |crossover| {
            mutations.into_iter().map(move |mutation| GeneticSettings {
                population: 21,
                elite: 12,
                mutants: 2,
                immigrants: 1,
                selection,
                crossover,
                bit_crossover: Crossover::OnePoint,
                mutation,
                bit_flip: 0.2,
            })
        })
    });
    all.map(move |settings| Genetic::new(genes, settings, 11).unwrap())
}

#[test]
fn the_search_of_chapter_6_draws_the_same_numbers_as_ever() {
    for (genes, settings, seed, hash, first, best) in [
        (
            3,
            shares(40, 0.2, 0.1),
            5,
            0x5c19_e777_065c_53b2,
            0.3384183371831253,
            0.03802131136547821,
        ),
        (
            1,
            shares(10, 0.3, 0.2),
            7,
            0x3d79_7f67_ce32_f20f,
            0.311263535252984,
            0.00012686722639521366,
        ),
        (
            21,
            shares(80, 0.4, 0.1),
            2010,
            0x63ad_5568_f7f0_a4d4,
            0.2077137024434328,
            2.273299606308289,
        ),
    ] {
        let mut search = Genetic::new(vec![(-1.0, 2.0); genes], settings, seed).unwrap();
        (0..25).for_each(|_| tell(&mut search, sphere));
        assert_eq!(search.population()[0], first);
        assert_eq!(search.leader().unwrap().fitness, best);
        // FNV-1a over the words.
        let came = search.population().iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, value| {
            (hash ^ value.to_bits()).wrapping_mul(0x100_0000_01b3)
        });
        assert_eq!(came, hash, "{genes} genes");
    }
}

#[test]
fn every_gene_stays_in_its_range_and_of_its_kind() {
    for mut search in searches() {
        for _ in 0..12 {
            for individual in search.ask() {
                check_chromosome(search.genes(), individual).unwrap();
            }
            tell(&mut search, |x| -x.iter().sum::<f64>());
        }
    }
}

#[test]
fn the_best_never_gets_worse_and_the_elite_is_kept() {
    for mut search in searches() {
        for _ in 0..12 {
            let mut before: Vec<Vec<f64>> = search.ask().map(<[f64]>::to_vec).collect();
            before.sort_by(|a, b| sphere(a).total_cmp(&sphere(b)));
            tell(&mut search, sphere);
            assert!(search.elite().zip(&before).all(|(kept, old)| kept == old));
            assert_eq!(search.elite().count(), 12);
        }
        assert!(search.history().best.is_sorted_by(|a, b| a >= b));
        assert_eq!(search.best().unwrap().fitness, search.history().best[11]);
    }
}

#[test]
fn a_search_continues_from_its_checkpoint_to_the_bit() {
    for mut search in searches() {
        (0..3).for_each(|_| tell(&mut search, sphere));
        search.tell(&[f64::NAN; 21]).unwrap();
        let text = search.to_json().unwrap();
        let mut again = Genetic::from_json(&text).unwrap();
        assert_eq!(again.to_json().unwrap(), text);
        for search in [&mut search, &mut again] {
            (0..3).for_each(|_| tell(search, sphere));
        }
        assert_eq!(again.to_json().unwrap(), search.to_json().unwrap());
    }
}

#[test]
fn damaged_checkpoints_are_refused() {
    let mut search = Genetic::new([(0.0, 1.0); 2], shares(4, 0.0, 0.0), 1).unwrap();
    tell(&mut search, sphere);
    let text = search.to_json().unwrap();
    for end in 0..text.trim_end().len() {
        assert!(Genetic::from_json(&text[..end]).is_err());
    }
    let one = format!("{:?}", search.population()[0]);
    for (old, new, part) in [
        (one.as_str(), "1.5", "individual 0: gene 0 must be a number from 0 to 1, got 1.5"),
        ("\"population\": 4", "\"population\": 5", "individuals: expected 5, got 4"),
        ("\"best_since\": 1", "\"best_since\": 2", "best_since must be at most"),
        ("\"elite\": 4", "\"elite\": 3", "elite_fitness: expected 3, got 4"),
        ("\"genetic\"", "\"tsk\"", "document type"),
    ] {
        let message = Genetic::from_json(&text.replacen(old, new, 1)).unwrap_err().to_string();
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn remembering_the_elite_changes_nothing_but_the_work() {
    let runs = [Elite::Remembered, Elite::Reevaluated].map(|elite| {
        let mut search = Genetic::new([(-1.0, 1.0); 3], shares(40, 0.2, 0.1), 9).unwrap();
        let mut evaluations = 0;
        let evaluate = |population: &[f64], fitness: &mut [f64]| -> Result<()> {
            evaluations += fitness.len();
            let rows = population.chunks_exact(3);
            fitness.iter_mut().zip(rows).for_each(|(f, x)| *f = sphere(x));
            Ok(())
        };
        search.run(Stop::after(50), elite, &Control::new(), evaluate).unwrap();
        (search.to_json().unwrap(), evaluations)
    });
    assert_eq!(runs[0].0, runs[1].0);
    assert_eq!((runs[0].1, runs[1].1), (40 + 49 * 12, 50 * 40));
}

#[test]
fn giving_up_who_is_not_below_the_bar_changes_nothing_but_the_mean() {
    let everybody = GeneticSettings { population: 40, ..GeneticSettings::default() };
    let cases = [(shares(40, 0.2, 0.1), true), (GeneticSettings::averaging(), true)];
    for (settings, expected) in cases.into_iter().chain([(everybody, false)]) {
        let mut given_up = 0;
        let [all, below] = [false, true].map(|gives_up| {
            let mut search = Genetic::new([(-1.0, 1.0); 3], settings, 9).unwrap();
            let evaluate = |population: &[f64], bar: f64, fitness: &mut [f64]| -> Result<()> {
                for (f, x) in fitness.iter_mut().zip(population.chunks_exact(3)) {
                    *f = sphere(x);
                    if gives_up && *f >= bar {
                        (*f, given_up) = (f64::INFINITY, given_up + 1);
                    }
                }
                Ok(())
            };
            let stop = Stop::after(50);
            search.run_below(stop, Elite::Remembered, &Control::new(), evaluate).unwrap();
            search
        });
        assert_eq!(given_up > 0, expected);
        assert_eq!(all.population(), below.population());
        assert_eq!((all.best(), all.leader()), (below.best(), below.leader()));
        assert_eq!(all.history().best, below.history().best);
        assert_eq!(all.history().mean != below.history().mean, expected);
    }
}

#[test]
fn a_run_stops_on_request_at_its_target_and_when_it_stagnates() {
    let run = |stop: Stop, control: &Control, evaluate: fn(&[f64]) -> f64| {
        let mut search = Genetic::new([(-1.0, 1.0)], GeneticSettings::default(), 9).unwrap();
        let evaluate = |population: &[f64], fitness: &mut [f64]| -> Result<()> {
            fitness.iter_mut().zip(population.chunks(1)).for_each(|(f, x)| *f = evaluate(x));
            Ok(())
        };
        let result = search.run(stop, Elite::Remembered, control, evaluate);
        (result, search)
    };
    let stop = Stop { target: Some(1e-4), ..Stop::after(500) };
    let (result, search) = run(stop, &Control::new(), sphere);
    assert!(result.is_ok() && search.generation() < 500);
    assert!(search.best().unwrap().fitness <= 1e-4);
    let stop = Stop { stagnation: Some(7), ..Stop::after(500) };
    let (_, search) = run(stop, &Control::new(), |_| 1.0);
    assert_eq!((search.generation(), search.stagnation()), (8, 7));

    let control = Control::new();
    control.cancel();
    let (result, search) = run(Stop::after(50), &control, sphere);
    assert_eq!(result, Err(Error::Cancelled));
    assert_eq!(search.generation(), 1);
    assert!(search.best().is_some());
    assert!(run(Stop::after(0), &Control::new(), sphere).0.is_err());
}

#[test]
fn pairs_have_two_children_cut_from_both() {
    // The i-th individual is (i, i, …): genes tell the parents.
    let mut search = Genetic::new([(0.0, 40.0); 4], shares(40, 0.2, 0.1), 1).unwrap();
    let vectors: Vec<Vec<f64>> = (0..40).map(|i| vec![f64::from(i); 4]).collect();
    search.start_from(vectors.iter().map(Vec::as_slice)).unwrap();
    tell(&mut search, |x| x[0]);
    for (number, child) in search.ask().skip(28).take(8).enumerate() {
        let pair = f64::from((number as u32 / 2) * 2);
        let (head, tail) = if number % 2 == 0 { (pair, pair + 1.0) } else { (pair + 1.0, pair) };
        assert_eq!((child[0], child[3]), (head, tail));
        assert!(child.iter().all(|&gene| gene == head || gene == tail));
    }
}

#[test]
fn the_search_of_chapter_3_averages_numbers_and_cuts_bits() {
    let genes: Vec<Gene> = (0..73)
        .map(|place| if place < 48 { Gene::Real { low: 0.0, high: 40.0 } } else { Gene::Bit })
        .collect();
    let mut search = Genetic::new(genes, GeneticSettings::averaging(), 3).unwrap();
    let vectors: Vec<Vec<f64>> = (0..40_u8)
        .map(|i| {
            let bit = f64::from(i % 2);
            [vec![f64::from(i); 48], vec![bit; 25]].concat()
        })
        .collect();
    search.start_from(vectors.iter().map(Vec::as_slice)).unwrap();
    tell(&mut search, |x| x[0]);
    assert!(search.ask().zip(&vectors).take(20).all(|(kept, parent)| kept == parent));
    for (number, child) in search.ask().skip(20).take(16).enumerate() {
        assert_eq!(child[..48], [number as f64 + 0.5; 48]);
        let cut = child[48..].iter().position(|&bit| bit != child[48]).unwrap();
        assert_eq!(child[48], (number % 2) as f64);
        assert!(child[48 + cut..].iter().all(|&bit| bit != child[48]));
    }
    let drawn = search.ask().skip(36).flat_map(|x| &x[..48]).collect::<Vec<_>>();
    assert_eq!(drawn.len(), 4 * 48);
    assert!(drawn.iter().all(|gene| gene.fract() != 0.0));
}

#[test]
fn a_mutant_differs_from_one_of_the_elite_in_one_gene() {
    let settings = GeneticSettings {
        population: 80,
        elite: 40,
        mutants: 8,
        immigrants: 0,
        ..GeneticSettings::averaging()
    };
    let mut search = Genetic::new([(-1.0, 1.0); 45], settings, 3).unwrap();
    for _ in 0..5 {
        tell(&mut search, sphere);
        for mutant in search.ask().skip(72) {
            let differences =
                |kept: &[f64]| kept.iter().zip(mutant).filter(|(a, b)| a != b).count();
            assert_eq!(search.elite().map(differences).min(), Some(1));
        }
    }
}

#[test]
fn tournaments_prefer_the_better() {
    // Children of a uniform crossover of constant individuals tell their parents; the chance of
    // rank r of n in a tournament of two is (2(n − r) − 1)/n².
    let settings = GeneticSettings {
        population: 1000,
        elite: 0,
        crossover: Crossover::Uniform,
        mutation: Mutation::None,
        ..GeneticSettings::default()
    };
    let mut search = Genetic::new([(0.0, 1000.0); 2], settings, 3).unwrap();
    let vectors: Vec<[f64; 2]> = (0..1000).map(|i| [f64::from(i); 2]).collect();
    search.start_from(vectors.iter().map(<[f64; 2]>::as_slice)).unwrap();
    tell(&mut search, |x| x[0]);
    let mean = search.population().iter().sum::<f64>() / 2000.0;
    // The mean rank is n/3, its standard deviation n/√18 over the root of the number drawn.
    assert!((mean - 333.0).abs() < 5.0 * 1000.0 / 18.0_f64.sqrt() / 1000.0_f64.sqrt(), "{mean}");
}

/// The genes of the children of two constant individuals, 0 and 1 in a range of ±10.
fn children_of_zero_and_one(crossover: Crossover, mutation: Mutation) -> Vec<f64> {
    let settings = GeneticSettings {
        population: 4,
        elite: 2,
        selection: Selection::Pairs,
        crossover,
        mutation,
        ..GeneticSettings::default()
    };
    let mut search = Genetic::new(vec![(-10.0, 10.0); 4000], settings, 3).unwrap();
    let vectors = [0.0, 1.0, 2.0, 3.0].map(|value| vec![value; 4000]);
    search.start_from(vectors.iter().map(Vec::as_slice)).unwrap();
    tell(&mut search, |x| x[0]);
    search.population()[8000..].to_vec()
}

/// Mean and standard deviation.
fn moments(numbers: &[f64]) -> (f64, f64) {
    let mean = numbers.iter().sum::<f64>() / numbers.len() as f64;
    let square = numbers.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
    (mean, (square / numbers.len() as f64).sqrt())
}

#[test]
fn crossovers_have_their_distributions() {
    let cross = |crossover| children_of_zero_and_one(crossover, Mutation::None);
    let uniform = cross(Crossover::Uniform);
    assert!(uniform.iter().all(|&gene| gene == 0.0 || gene == 1.0));
    assert!((moments(&uniform[..4000]).0 - 0.5).abs() < 5.0 * 0.5 / 4000.0_f64.sqrt());

    let blend = cross(Crossover::blx(0.3));
    let ends = blend.iter().fold((0.5_f64, 0.5_f64), |(a, b), &x| (a.min(x), b.max(x)));
    assert!(-0.3 <= ends.0 && ends.0 < -0.28 && 1.28 < ends.1 && ends.1 <= 1.3, "{ends:?}");
    assert!((moments(&blend[..4000]).1 - 1.6 / 12.0_f64.sqrt()).abs() < 0.02);

    let (first, second) = (cross(Crossover::average(0.7)), cross(Crossover::average(0.25)));
    assert!((first[0] - 0.3).abs() < 1e-15 && (first[7999] - 0.7).abs() < 1e-15);
    assert!(second[..4000].iter().all(|&gene| gene == 0.75));
    let random = cross(Crossover::Average { low: 0.0, high: 1.0 });
    assert!(random[..4000].iter().all(|&gene| gene == random[0] && (0.0..=1.0).contains(&gene)));

    // All couples keep their mean; half of the children of SBX lie between the parents.
    let binary = cross(Crossover::SimulatedBinary { eta: 2.0 });
    for (a, b) in binary[..4000].iter().zip(&binary[4000..]) {
        assert!((a + b - 1.0).abs() < 1e-12);
    }
    let between = binary[..4000].iter().filter(|gene| (0.0..=1.0).contains(*gene)).count();
    assert!(between.abs_diff(2000) < 160, "{between}");
    // The density inside is (η + 1)/2·β^η: for η = 2 the mean of β there is 3/4.
    let inside = binary[..4000].iter().filter(|gene| (0.0..=1.0).contains(*gene));
    let spread = inside.map(|gene| (2.0 * gene - 1.0).abs()).sum::<f64>() / between as f64;
    assert!((spread - 0.75).abs() < 0.025, "{spread}");
}

#[test]
fn mutations_have_their_distributions() {
    // Both children of the average are ½ everywhere before the mutation.
    let steps = |mutation| -> Vec<f64> {
        let children = children_of_zero_and_one(Crossover::average(0.5), mutation);
        children.into_iter().map(|gene| gene - 0.5).filter(|&step| step != 0.0).collect()
    };
    let close = |count: usize, rate: f64| {
        let expected = 8000.0 * rate;
        (count as f64 - expected).abs() < 5.0 * (expected * (1.0 - rate)).sqrt()
    };
    assert!(steps(Mutation::None).is_empty());
    let gaussian = steps(Mutation::Gaussian { rate: 0.25, scale: 0.05 });
    assert!(close(gaussian.len(), 0.25), "{}", gaussian.len());
    let (mean, deviation) = moments(&gaussian);
    assert!(mean.abs() < 0.12 && (deviation - 1.0).abs() < 0.08, "{mean} {deviation}");
    // E δ² of the polynomial step is 2/((η + 2)(η + 3)) within ±1.
    let polynomial = steps(Mutation::Polynomial { rate: 0.5, eta: 20.0 });
    assert!(close(polynomial.len(), 0.5), "{}", polynomial.len());
    let (mean, deviation) = moments(&polynomial);
    let expected = 20.0 * (2.0 / (22.0 * 23.0_f64)).sqrt();
    assert!(mean.abs() < 0.1 && (deviation - expected).abs() < 0.1, "{mean} {deviation}");
    let redrawn = steps(Mutation::Redraw { rate: 0.5 });
    assert!(close(redrawn.len(), 0.5));
    assert!((moments(&redrawn).1 - 20.0 / 12.0_f64.sqrt()).abs() < 0.3);
}

#[test]
fn fitness_that_is_not_finite_never_wins_and_the_best_is_never_lost() {
    let mut search = Genetic::new([(-1.0, 1.0)], shares(40, 0.2, 0.1), 2).unwrap();
    let mut fitness = vec![f64::NAN; 40];
    fitness[3] = f64::NEG_INFINITY;
    fitness[4] = f64::INFINITY;
    search.tell(&fitness).unwrap();
    assert!(search.best().is_none() && search.history().best[0].is_nan());
    fitness[17] = 1e300;
    let winner = search.ask().nth(17).unwrap().to_vec();
    search.tell(&fitness).unwrap();
    assert_eq!(search.best().unwrap().genes, winner);
    assert_eq!(search.leader(), search.best());
    assert_eq!(search.history().mean[1], 1e300);
    search.tell(&[f64::NAN; 40]).unwrap();
    assert!(search.leader().is_none());
    assert_eq!(search.best().unwrap().genes, winner);
    search.tell(&[2e300; 40]).unwrap();
    assert_eq!(search.leader().unwrap().fitness, 2e300);
    assert_eq!(search.best().unwrap().fitness, 1e300);
    assert_eq!(search.stagnation(), 2);
}

#[test]
fn constraints_go_before_fitness() {
    let settings = GeneticSettings { elite: 4, ..shares(4, 0.0, 0.0) };
    let mut search = Genetic::new([(0.0, 9.0)], settings, 2).unwrap();
    let vectors = [[1.0], [2.0], [3.0], [4.0]];
    search.start_from(vectors.iter().map(<[f64; 1]>::as_slice)).unwrap();
    let nan = f64::NAN;
    search.tell_constrained(&[1.0, 9.0, nan, 5.0], &[0.5, -1.0, 0.1, 0.0]).unwrap();
    let order: Vec<f64> = search.elite().map(|x| x[0]).collect();
    assert_eq!(order, [4.0, 2.0, 3.0, 1.0]);
    assert_eq!(search.best().unwrap().fitness, 5.0);
    assert_eq!(search.history().mean, [7.0]);
    search.tell_constrained(&[0.0; 4], &[1.0, nan, 0.5, 2.0]).unwrap();
    assert!(search.leader().is_none());
    assert_eq!(search.best().unwrap().fitness, 5.0);
    assert!(search.tell_constrained(&[0.0; 4], &[0.0; 3]).is_err());
}

#[test]
fn repair_reaches_all_but_the_elite_and_keeps_the_ranges() {
    let mut search = Genetic::new([(0.0, 1.0); 2], shares(10, 0.2, 0.2), 2).unwrap();
    search.repair(|x| x[1] = 1.0 - x[0]);
    tell(&mut search, sphere);
    search.repair(|x| x.copy_from_slice(&[f64::NAN, 7.0]));
    assert!(search.elite().all(|x| x[0] + x[1] == 1.0));
    assert_eq!(search.elite().count(), 6);
    assert!(search.ask().skip(6).all(|x| x == [0.0, 1.0]));
}

#[test]
fn the_defaults_solve_what_they_should() {
    let ones = |x: &[f64]| -x.iter().sum::<f64>();
    let mut search = Genetic::new([Gene::Bit; 40], GeneticSettings::default(), 5).unwrap();
    (0..120).for_each(|_| tell(&mut search, ones));
    assert_eq!(search.best().unwrap().fitness, -40.0);

    let rastrigin = |x: &[f64]| -> f64 {
        let wave = |v: f64| v * v - 10.0 * crate::math::sin_cos(std::f64::consts::TAU * v).1;
        40.0 + x.iter().map(|&v| wave(v)).sum::<f64>()
    };
    let settings = GeneticSettings { population: 100, ..GeneticSettings::default() };
    let mut search = Genetic::new([(-5.12, 5.12); 4], settings, 5).unwrap();
    (0..150).for_each(|_| tell(&mut search, rastrigin));
    assert!(search.best().unwrap().fitness < 1.0, "{:?}", search.best());
}

#[test]
fn impossible_settings_and_bounds_are_refused() {
    for (population, crossover, mutation) in
        [(3, 0.2, 0.1), (40, 0.6, 0.1), (40, 0.2, 0.9), (40, -0.1, 0.1), (40, f64::NAN, 0.0)]
    {
        assert!(GeneticSettings::with_shares(population, crossover, mutation).is_err());
    }
    let good = GeneticSettings::default;
    let message = |settings: GeneticSettings| settings.check().unwrap_err().to_string();
    for (settings, part) in [
        (GeneticSettings { population: 3, ..good() }, "population must be at least 4, got 3"),
        (GeneticSettings { elite: 41, ..good() }, "together must be at most the population, 40"),
        (GeneticSettings { mutants: usize::MAX, ..good() }, "together must be"),
        (GeneticSettings { elite: 0, mutants: 1, ..good() }, "elite, whose members are the"),
        (GeneticSettings { selection: Selection::Pairs, ..good() }, "must be at least 38, got 2"),
        (GeneticSettings { elite: 20, immigrants: 0, ..GeneticSettings::averaging() }, "least 21"),
        (GeneticSettings { selection: Selection::Tournament(0), ..good() }, "tournament must be"),
        (GeneticSettings { selection: Selection::Tournament(99), ..good() }, "tournament must be"),
        (GeneticSettings { crossover: Crossover::blx(f64::NAN), ..good() }, "least weight"),
        (GeneticSettings { crossover: Crossover::blx(-1.0), ..good() }, "greatest weight"),
        (GeneticSettings { bit_crossover: Crossover::blx(0.1), ..good() }, "bits cannot be mixed"),
        (GeneticSettings { mutation: Mutation::Redraw { rate: 2.0 }, ..good() }, "rate of the"),
        (GeneticSettings { bit_flip: -0.1, ..good() }, "bit_flip must be between 0 and 1"),
    ] {
        let message = message(settings);
        assert!(message.contains(part), "{message}");
    }
    let new = |genes: Vec<Gene>| Genetic::new(genes, good(), 0).map(drop);
    let largest = 1_i64 << 53;
    assert!(new(vec![Gene::Integer { low: -largest, high: largest }]).is_ok());
    for genes in [
        vec![Gene::from((1.0, 0.0))],
        vec![Gene::from((0.0, f64::INFINITY))],
        vec![Gene::from((f64::NAN, 1.0))],
        vec![Gene::from((-f64::MAX, f64::MAX))],
        vec![Gene::Integer { low: 2, high: 1 }],
        vec![Gene::Integer { low: i64::MIN, high: 0 }],
        vec![],
    ] {
        assert!(new(genes).is_err());
    }
    let mut search = Genetic::new([(0.0, 1.0); 3], good(), 0).unwrap();
    assert!(search.tell(&[0.0; 39]).is_err());
    assert!(search.start_from([[0.0; 2].as_slice()]).is_err());
    assert!(search.start_from([[0.0, 2.0, 0.0].as_slice()]).is_err());
    assert!(search.start_from(vec![[0.0; 3].as_slice(); 41]).is_err());
}
