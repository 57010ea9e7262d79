use etendue::io::write_png_pixels;
use etendue::measure::colour_map::magma;
use etendue::measure::compare;
use etendue::measure::flip::{FlipOptions, flip};
use serde_json::json;

use crate::args::CompareArgs;
use crate::error::CliError;
use crate::outputs::{check_distinct, check_place, write_json};
use crate::picture;
use crate::session::{print, say};

pub(crate) fn run(args: &CompareArgs) -> Result<(), CliError> {
    check_distinct(args.json.iter().chain(&args.flip))?;
    for path in args.json.iter().chain(&args.flip) {
        check_place(path)?;
    }
    let (a, r) = (picture::read(&args.a)?, picture::read(&args.reference)?);
    let (name_a, name_r) = (args.a.display(), args.reference.display());
    if a.size != r.size {
        let [w, h] = a.size;
        let [v, k] = r.size;
        let both = format!("'{name_a}' has {w}x{h} pixels and '{name_r}' {v}x{k}");
        return Err(CliError::Usage(format!("{both}; render both in one size")));
    }
    let c = compare(&a.rgb, &r.rgb)?;
    for (count, name) in [(c.not_finite, &name_a), (c.reference_not_finite, &name_r)] {
        if count > 0 {
            say(&format!("warning: {count} pixels of '{name}' are no numbers; they are left out"));
        }
    }
    if c.pixels == 0 {
        return Err(CliError::Usage(
            "no pixel is a number in both pictures; there is nothing to compare".into(),
        ));
    }
    let map = flip(&a.rgb, &r.rgb, a.size, FlipOptions::default())?;
    let three = |v: [f64; 3]| v.map(|x| format!("{x:.6}")).join(" ");
    let ratio = c.ratio().map(|r| r.map_or_else(|| "-".to_owned(), |x| format!("{x:.6}"))).join(" ");
    print(&format!("RMSE            {:.6e}", c.rmse))?;
    print(&format!("relMSE          {:.6e}", c.relative_mse))?;
    print(&format!("relMSE trimmed  {:.6e}", c.relative_mse_trimmed))?;
    print(&format!("FLIP            {:.6}", map.mean()))?;
    print(&format!("mean            {}", three(c.mean)))?;
    print(&format!("reference mean  {}", three(c.reference_mean)))?;
    print(&format!("ratio           {ratio}"))?;
    if let Some(path) = &args.json {
        let report = json!({
            "a": name_a.to_string(),
            "reference": name_r.to_string(),
            "size": a.size,
            "pixels": c.pixels,
            "not_finite": c.not_finite,
            "reference_not_finite": c.reference_not_finite,
            "rmse": c.rmse,
            "relmse": c.relative_mse,
            "relmse_trimmed": c.relative_mse_trimmed,
            "flip": map.mean(),
            "flip_max": map.max(),
            "mean": c.mean,
            "reference_mean": c.reference_mean,
            "ratio": c.ratio(),
        });
        write_json(path, &report)?;
    }
    if let Some(path) = &args.flip {
        let colours: Vec<[u8; 3]> = map.values.iter().map(|v| magma(*v)).collect();
        write_png_pixels(path, a.size, &colours)?;
    }
    Ok(())
}
