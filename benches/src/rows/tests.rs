use super::*;

type Failure = Box<dyn std::error::Error>;

/// A table of some runs, and which of them were computed.
fn study(runs: &Runs, failing_at: usize) -> Result<(String, Vec<usize>), Failure> {
    let (mut sum, mut computed, mut words) = (0.0, Vec::new(), Vec::new());
    for k in 0..10 {
        let made = runs.next(|| -> Result<_, Failure> {
            if k == failing_at {
                return Err("killed".into());
            }
            computed.push(k);
            Ok((1.0 / (k as f64 - 3.0), (k % 2 == 0).then(|| format!("{k}\n\"")), [k, k * k]))
        })?;
        let Some((number, word, [_, square])) = made else { continue };
        sum += if number.is_finite() { number } else { square as f64 };
        words.extend(word);
    }
    Ok((format!("{sum:?} {words:?}"), computed))
}

fn runs(options: &[&str]) -> Result<Runs, Why> {
    let runs = Runs::new();
    runs.begin(&["small".to_owned(), "7".to_owned()], options)?;
    Ok(runs)
}

fn folder(name: &str) -> String {
    let path = std::env::temp_dir().join(format!("recon-rows-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&path);
    path.to_string_lossy().into_owned()
}

#[test]
fn parts_that_were_broken_off_and_gone_on_with_merge_to_the_table_of_one_process() -> Result<(), Failure> {
    let folder = folder("merged");
    for part in ["0/3", "1/3"] {
        study(&runs(&["--shard", part, "--rows", &folder])?, 99)?;
    }
    let last = ["--shard", "2/3", "--rows", &folder];
    assert!(study(&runs(&last)?, 8).is_err());
    let path = Path::new(&folder).join("2-of-3.rows");
    // As if the process had ended in the middle of a line.
    OpenOptions::new().append(true).open(path)?.write_all(b"[\"8\",\"0.")?;
    assert_eq!(study(&runs(&last)?, 99)?.1, [8]);
    let (merged, computed) = study(&runs(&["--merge", &folder])?, 99)?;
    assert_eq!((merged, computed.len()), (study(&runs(&[])?, 99)?.0, 0));
    Ok(fs::remove_dir_all(folder)?)
}

#[test]
fn a_study_takes_a_part_or_says_why_there_is_none() -> Result<(), Failure> {
    let folder = folder("asked");
    let asked = |parts, words: &[&str]| {
        let runs = Runs::new();
        let words: Vec<String> = words.iter().map(ToString::to_string).collect();
        runs.asked(parts, &words).map(|()| runs).map_err(|error| error.to_string())
    };
    let whole = Parts::Whole("it is done within minutes");
    let part = ["small", "7", "--shard", "1/2", "--rows", &folder];
    let refused = asked(whole, &part).map(|_| ());
    assert_eq!(refused, Err("it is not made in parts: it is done within minutes".to_owned()));
    assert!(asked(whole, &part[..2]).is_ok() && asked(whole, &["small", "--merge", &folder]).is_err());
    assert_eq!(study(&asked(Parts::OfRuns, &part)?, 99)?.1, [1, 3, 5, 7, 9]);
    Ok(fs::remove_dir_all(folder)?)
}

#[test]
fn what_is_missing_twice_or_of_another_study_is_named() -> Result<(), Failure> {
    let folder = folder("wrong");
    study(&runs(&["--shard", "0/2", "--rows", &folder])?, 99)?;
    let said = |error: Failure| error.to_string();
    let missing = study(&runs(&["--merge", &folder])?, 99).map_err(said);
    assert_eq!(missing, Err("run 1 is in no file; do its part first".to_owned()));
    study(&runs(&["--shard", "0/1", "--rows", &folder])?, 99)?;
    assert!(matches!(runs(&["--merge", &folder]), Err(Why::Twice { run: 0, .. })));
    let other = Runs::new().begin(&["small".to_owned()], &["--merge", &folder]);
    assert!(matches!(other, Err(Why::OtherStudy { .. })));
    for wrong in [&["--shard", "2/2", "--rows", &folder][..], &["--merge"]] {
        assert!(runs(wrong).is_err());
    }
    Ok(fs::remove_dir_all(folder)?)
}
