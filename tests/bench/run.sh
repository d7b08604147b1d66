# Runs each benchmark once: all declared ones run to their end, and those that count items have items to process. The
# times mean nothing here.
#   bash run.sh BIN_DIR [EXECUTABLE FOLDER LEAST]     sparselens-bench, of tests/bench, 30 at least
. "$(dirname "$0")/../tools/check.sh"
bench=$bin/${2-sparselens-bench} folder=${3-tests/bench}
command -v python3 >/dev/null || skip "needs python3 to read JSON"
exits 0 "$bench" --benchmark_list_tests
mv stdout declared
exits 0 "$bench" --benchmark_min_time=0.0001 --benchmark_out=results.json --benchmark_out_format=json
python3 - "$source_dir/$folder" "${4-30}" <<'END_OF_PYTHON'
import json, pathlib, re, sys
declared = open("declared").read().split()
results = {b["name"].removesuffix("/real_time"): b for b in json.load(open("results.json"))["benchmarks"]}
faults = []
for name in declared:
    b = results.get(name.removesuffix("/real_time"))
    if b is None:
        faults.append(name + " did not run")
    elif b.get("error_occurred"):
        faults.append(name + ": " + b["error_message"])
    elif b["iterations"] < 1 or not b["real_time"] > 0:
        faults.append(name + " did nothing")
    elif not name.startswith("psf_") and not b.get("items_per_second", 0) > 0:
        faults.append(name + " worked on nothing")
# Each benchmark file has some: the functions that it passes on, or the names that it registers.
for file in sorted(pathlib.Path(sys.argv[1]).glob("*_bench.cpp")):
    text = file.read_text()
    for name in re.findall(r"^BENCHMARK(?:_CAPTURE)?\((\w+)", text, re.M) + re.findall(r'measure\("([\w/]+)"', text):
        if not any(d == name or d.startswith(name + "/") for d in declared):
            faults.append(f"{name} of {file.name} is not declared")
if len(declared) < int(sys.argv[2]):
    faults.append(f"only {len(declared)} benchmarks")
sys.exit("\n".join(["FAIL:"] + faults) if faults else 0)
END_OF_PYTHON
