//! Integrals to a stated error.

/// Places of the Gauss–Kronrod rule of 15 points in [0, 1], its weights, and those of the Gauss rule of 7 points among them
/// (0 for the others). R. Piessens et al., QUADPACK, Springer 1983.
const RULE: [[f64; 3]; 8] = [
    [0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0],
    [0.949_107_912_342_758_5, 0.063_092_092_629_978_54, 0.129_484_966_168_869_7],
    [0.864_864_423_359_769_1, 0.104_790_010_322_250_17, 0.0],
    [0.741_531_185_599_394_3, 0.140_653_259_715_525_92, 0.279_705_391_489_276_64],
    [0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0],
    [0.405_845_151_377_397_2, 0.190_350_578_064_785_4, 0.381_830_050_505_118_9],
    [0.207_784_955_007_898_48, 0.204_432_940_075_298_9, 0.0],
    [0.0, 0.209_482_141_084_727_82, 0.417_959_183_673_469_4],
];

/// How often an interval is halved at most.
const DEEPEST: u32 = 40;

/// Integral of a function from `low` to `high`. Intervals are halved until the rules of 7 and of 15 points agree to `error` in
/// each.
pub(super) fn integral(function: &impl Fn(f64) -> f64, [low, high]: [f64; 2], error: f64) -> f64 {
    halved(function, [low, high], error, DEEPEST)
}

/// The same for an interval that may be halved so often.
fn halved(function: &impl Fn(f64) -> f64, [low, high]: [f64; 2], error: f64, more: u32) -> f64 {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let (mut kronrod, mut gauss) = (0.0, 0.0);
    for [place, weight, gauss_weight] in RULE {
        let value = match place > 0.0 {
            true => function(middle - half * place) + function(middle + half * place),
            false => function(middle),
        };
        kronrod += weight * value;
        gauss += gauss_weight * value;
    }
    if more == 0 || ((kronrod - gauss) * half).abs() <= error {
        return kronrod * half;
    }
    halved(function, [low, middle], error, more - 1) + halved(function, [middle, high], error, more - 1)
}
