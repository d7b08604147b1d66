# Error against run time of three scenes, and of yard if it is there: the ways that people choose between, in tables.
# results/report.csv has all rows. 30 minutes.
. "$(dirname "$0")/common.inc" "$1"
scenes=(fence grass lamps)
if [ -e "$shared/views/yard" ]; then
    ln -sfn "$shared/views/yard" yard # the report names a scene as given
    scenes+=(yard)
fi
dof-report "${scenes[@]}" -o report >text
cp report/report.csv "$(dirname "$0")/../results/report.csv"
python3 - <<'END'
import csv

SHOWN = ["one view, lens normal", "4 peeled layers, lens normal", "accumulated lens views", "distributed ray tracing",
         "denoised ray tracing", "centre + 4, lens normal", "centre + 4, lens final", "centre + 4 at 2x, lens normal",
         "centre + 4 planned, lens normal", "centre + 4 denoised, lens normal", "centre + 4 denoised at 2x, lens normal"]
COLUMNS = {"rays": "rays", "seconds": "seconds", "dB": "psnr_tonemapped", "worst": "psnr_worst", "FLIP": "flip",
           "seconds of ray tracing": "equal_error_seconds", "rays of it": "equal_error_rays", "dB gained": "equal_time_db"}
scenes = {}
for row in csv.DictReader(open("report/report.csv")):
    scenes.setdefault(row["scene"], []).append(row)
said = open("text").read().split("\n\n")
print("`dof-report " + " ".join(scenes) + " -o report`")
for scene, rows in scenes.items():
    print(f"\n### {scene}, {rows[0]['size']}\n\n| method | budget | " + " | ".join(COLUMNS) + " |")
    print("|---|---" + "|---" * len(COLUMNS) + "|")
    for row in rows:
        method = ", ".join(filter(None, (row["renderer"], row["processor"])))
        if method in SHOWN:
            numbers = [row[name] and f"{float(row[name]):.4g}" for name in COLUMNS.values()]
            print(f"| {method} | {row['budget']} | " + " | ".join(numbers) + " |")
    (verdict,) = [text for text in said if text.startswith(scene + ",")]
    lines = verdict.split("\n")
    first = next(i for i, line in enumerate(lines) if line.startswith(("Least error", "No sparse")))
    print("\n" + " ".join(lines[first:first + 2]), end="")
    poor = sum(" is a poor choice: " in line for line in lines)
    print(f" {poor} rows of report.csv are poor choices: another way is no slower and no worse." if poor else "")
END
