use super::*;

#[test]
fn what_a_killed_run_left_goes_with_the_next_one_and_what_is_in_use_stays() {
    let scratch = Scratch::new("killed");
    let (out, log) = (scratch.path("out"), scratch.path("log.csv"));
    // A killed process removes nothing and lets go of its locks: that of a file is on the file itself.
    let leave = |hidden: &str| {
        fs::create_dir(scratch.path(hidden)).unwrap();
        fs::write(scratch.path(hidden).join(".in-use"), "").unwrap();
        fs::write(scratch.path(hidden).join("motion.csv"), "half").unwrap();
    };
    leave(".out.partial-7");
    leave(".other.partial-7");
    fs::write(scratch.path(".log.csv.partial-7"), "half").unwrap();
    fs::write(scratch.path(".log.csv.partial-final"), "a user's").unwrap();
    fs::create_dir(scratch.path(".out.partial-8")).unwrap();
    write_folder(&out, &["a.csv"], "one", false).unwrap();
    write_file(&log, &[], "one").unwrap();
    let left = [".log.csv.partial-final", ".other.partial-7", ".out.partial-8", "log.csv", "out"];
    assert_eq!(scratch.names(""), left, "without a lock file, or of another target");
    // Within results: what is in use is named, what was left behind is not.
    leave("out/.recon-partial-7");
    let held = fs::File::open(scratch.path("out/.recon-partial-7/.in-use")).unwrap();
    held.try_lock().unwrap();
    assert!(words(write_folder(&out, &["a.csv"], "two", false)).contains(".recon-partial-7"));
    drop(held);
    write_folder(&out, &["a.csv"], "two", false).unwrap();
    assert_eq!(
        (scratch.names("out"), scratch.read("out/a.csv")),
        (vec!["a.csv".into(), MANIFEST.into()], "two".into())
    );
    // Files of an earlier run that are in no place any more are never removed.
    leave("out/.recon-partial-7");
    fs::create_dir(scratch.path("out/.recon-partial-7/earlier")).unwrap();
    fs::write(scratch.path("out/.recon-partial-7/earlier/b.csv"), "results").unwrap();
    assert!(words(write_folder(&out, &["a.csv"], "three", false)).contains(".recon-partial-7"));
    let running = FolderTarget::new(scratch.path("new"), &[], false).unwrap().begin().unwrap();
    let in_use = scratch.names("").into_iter().find(|name| name.starts_with(".new.partial-")).unwrap();
    remove_left_behind(&scratch.0);
    assert_eq!(scratch.names(""), [".log.csv.partial-final", &in_use, ".out.partial-8", "log.csv", "out"]);
    running.place().unwrap();
    assert_eq!(scratch.names("new"), [MANIFEST]);
}
