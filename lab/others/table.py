"""Prints the rows of report.csv at equal rays as Markdown: python table.py report.csv. Each cell: dB, worst blocks
(dB), FLIP, seconds."""
import csv
import json
import os
import sys

rows = list(csv.DictReader(open(sys.argv[1])))
scenes = list(dict.fromkeys(row["scene"] for row in rows))
ways = [("ray tracing", "distributed ray tracing", ""), ("denoised", "denoised ray tracing", ""),
        ("averages", "accumulated lens views", ""), ("five views", "centre + 4", "lens normal"),
        ("five views, denoised", "centre + 4 denoised", "lens normal"), ("five fine views", "centre + 4 at 2x", "lens normal"),
        ("five fine views, denoised", "centre + 4 denoised at 2x", "lens normal"), ("views and rays, finished", "views and rays", "finished"),
        ("views and rays, finished, denoised", "views and rays", "finished, denoised"),
        ("half in views, finished", "views and rays", "half")]


def figures(row):
    return (f"{float(row['psnr_tonemapped']):.2f}, {float(row['psnr_worst']):.2f}, {float(row['flip'] or 'nan'):.4f}, "
            f"{float(row['seconds']):.2f} s")


def advice(scene):
    path = os.path.join(os.path.dirname(sys.argv[1]), os.pardir, scene, "advice.json")
    return json.load(open(path)) if os.path.exists(path) else {}


print("| scene, rays | " + " | ".join(way[0] for way in ways) + " | `ldi-plan` advises |")
print("|---" * (2 + len(ways)) + "|")
for scene in scenes:
    of_scene = [row for row in rows if row["scene"] == scene]
    numbers = sorted({float(row["rays"]) for row in of_scene for _, renderer, processor in ways
                      if row["renderer"] == renderer and row["processor"] == processor})
    for rays in numbers:
        cells = []
        for _, renderer, processor in ways:
            found = [row for row in of_scene
                     if (row["renderer"], row["processor"], float(row["rays"])) == (renderer, processor, rays)]
            cells.append(figures(found[0]) if found else "")
        print(f"| {scene}, {rays:g} | " + " | ".join(cells) + f" | {advice(scene).get(f'{rays:g}', '')} |")

print("\n| scene | of one view | rays | |\n|---|---|---|---|")
for scene in scenes:
    for row in rows:
        if row["scene"] == scene and row["renderer"] == "one view" and ("(" in row["processor"] or row["processor"] == "lens normal"):
            if row["processor"] != "lens normal" or any("(" in r["processor"] and r["scene"] == scene and r["rays"] == row["rays"] for r in rows):
                print(f"| {scene} | {row['processor']} | {float(row['rays']):g} | {figures(row)} |")

print("\n| scene | pull of 16 frames | flicker | sparkle | largest |\n|---|---|---|---|---|")
for row in rows:
    if row["pull_largest"]:
        name = row["renderer"] + (", " + row["processor"] if row["processor"] else "")
        print(f"| {row['scene']} | {name}, {row['budget']} | {row['pull_flickering_pixels']} | {row['pull_sparkling_pixels']} | "
              f"{float(row['pull_largest']):.2f} |")
