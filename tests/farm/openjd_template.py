"""Checks templates of Open Job Description, and runs them as a session would.

    openjd_template.py check SCHEMA TEMPLATE...       do the schema and the rules below allow them?
    openjd_template.py faults SCHEMA TEMPLATE...      does the check find a fault of every kind put into them?
    openjd_template.py run TEMPLATE FOLDER NAME=VALUE...    run all tasks, with the parameters' values

Exit code 0: yes; 1: no, with a line that says why. The rules are those of the specification 2023-09.
"""
import copy
import pathlib
import re
import subprocess
import sys

import jsonschema
import yaml

REFERENCE = re.compile(r"\{\{\s*([\w.]+)\s*\}\}")


def load(path):
    return yaml.safe_load(pathlib.Path(path).read_text(encoding="utf-8"))


def unique(names, what):
    names = list(names)
    if len(set(names)) != len(names):
        raise ValueError(f"two {what} have the same name: {names}")


def references(value):
    """The names in the format strings of a value."""
    if isinstance(value, dict):
        return [name for part in value.values() for name in references(part)]
    if isinstance(value, list):
        return [name for part in value for name in references(part)]
    return REFERENCE.findall(value) if isinstance(value, str) else []


def expect(value, known, where):
    for name in references(value):
        if name not in known:
            raise ValueError(f"{where}: nothing gives {name} a value here")


def longest(text, parameters):
    """The largest length of a format string: parameters have 1024 characters, unless they say less."""
    most = {f"{kind}.{p['name']}": p.get("maxLength", 1024) for p in parameters for kind in ("Param", "RawParam")}
    return len(REFERENCE.sub("", text)) + sum(most[name] for name in references(text))


def check_parameter(parameter):
    allowed, control = parameter.get("allowedValues"), parameter.get("userInterface", {}).get("control", "HIDDEN")
    if allowed is not None and parameter.get("default", allowed[0]) not in allowed:
        raise ValueError(f"{parameter['name']}: the default is not among the allowed values")
    if control in ("DROPDOWN_LIST", "CHECK_BOX") and allowed is None:
        raise ValueError(f"{parameter['name']}: {control} needs allowedValues")
    if len(str(parameter.get("default", "x" * 1024))) < parameter.get("minLength", 0):
        raise ValueError(f"{parameter['name']}: the default is shorter than minLength")


def check_step(step, earlier, job, raw, extensions):
    """Checks scopes of values, dependencies, requirements, and features of extensions."""
    for dependency in step.get("dependencies", []):
        if dependency["dependsOn"] not in earlier:
            raise ValueError(f"{step['name']} depends on {dependency['dependsOn']}, which is no other step before it")
    for kind in ("amounts", "attributes"):
        unique((entry["name"].lower() for entry in step.get("hostRequirements", {}).get(kind, [])), kind)
    tasks = step.get("parameterSpace", {}).get("taskParameterDefinitions", [])
    unique((task["name"] for task in tasks), "task parameters")
    if any(task["type"] == "CHUNK[INT]" for task in tasks) and "TASK_CHUNKING" not in extensions:
        raise ValueError("CHUNK[INT] needs the extension TASK_CHUNKING")
    if sum(task["type"] == "CHUNK[INT]" for task in tasks) > 1:
        raise ValueError("more than one CHUNK[INT]")
    expect(step.get("parameterSpace", {}), raw, f"{step['name']}: parameterSpace")
    script = step["script"]
    files = [file["name"] for file in script.get("embeddedFiles", [])]
    unique(files, "embedded files")
    session = {"Session.WorkingDirectory", "Session.HasPathMappingRules", "Session.PathMappingRulesFile"}
    task_names = {f"Task.{kind}.{task['name']}" for task in tasks for kind in ("Param", "RawParam")}
    expect(script, job | raw | session | task_names | {f"Task.File.{name}" for name in files}, step["name"])


def check(template, schema):
    jsonschema.Draft7Validator(schema).validate(template)
    parameters = template.get("parameterDefinitions", [])
    unique((parameter["name"] for parameter in parameters), "parameters")
    for parameter in parameters:
        check_parameter(parameter)
    # Values of PATH parameters are available where a script runs, because paths are mapped there.
    raw = {f"RawParam.{p['name']}" for p in parameters} | {f"Param.{p['name']}" for p in parameters if p["type"] != "PATH"}
    job = {f"Param.{p['name']}" for p in parameters}
    expect(template["name"], raw, "name")
    if longest(template["name"], parameters) > 128:
        raise ValueError("name: may be longer than 128 characters once its parameters have values")
    unique((step["name"] for step in template["steps"]), "steps")
    for i, step in enumerate(template["steps"]):
        check_step(step, [s["name"] for s in template["steps"][:i]], job, raw, template.get("extensions", []))


def faults():
    """Faults to put into a template: a description of each, and a function that applies it."""
    def step(t):
        return t["steps"][1]

    def action(t):
        return step(t)["script"]["actions"]["onRun"]

    def space(t):
        return step(t)["parameterSpace"]["taskParameterDefinitions"]

    return {
        "another version": lambda t: t.update(specificationVersion="jobtemplate-2022-01"),
        "no steps": lambda t: t.update(steps=[]),
        "an unknown property": lambda t: t.update(step=[]),
        "an unknown extension": lambda t: t.update(extensions=["TASK_CHUNKS"]),
        "a line feed in the name": lambda t: t.update(name="a\nb"),
        "a name that may become too long": lambda t: t.update(name="sparselens {{Param.Frames}}"),
        "a path in the name": lambda t: t.update(name="{{Param.Views}}"),
        "two parameters of one name": lambda t: t["parameterDefinitions"].append(t["parameterDefinitions"][0]),
        "a parameter's name": lambda t: t["parameterDefinitions"][0].update(name="the views"),
        "a parameter's type": lambda t: t["parameterDefinitions"][0].update(type="FOLDER"),
        "objectType": lambda t: t["parameterDefinitions"][0].update(objectType="FOLDER"),
        "dataFlow": lambda t: t["parameterDefinitions"][0].update(dataFlow="INPUT"),
        "dataFlow of a string": lambda t: t["parameterDefinitions"][2].update(dataFlow="IN"),
        "a default that is no string": lambda t: t["parameterDefinitions"][2].update(default=24),
        "an empty default": lambda t: t["parameterDefinitions"][2].update(default=""),
        "a control without its values": lambda t: t["parameterDefinitions"][2].update(userInterface={"control": "DROPDOWN_LIST"}),
        "a dependency on nothing": lambda t: step(t).update(dependencies=[{"dependsOn": "render"}]),
        "a dependency on itself": lambda t: step(t).update(dependencies=[{"dependsOn": "gather"}]),
        "two steps of one name": lambda t: step(t).update(name="warp"),
        "an amount without number": lambda t: step(t)["hostRequirements"].update(amounts=[{"name": "amount.worker.vcpu"}]),
        "an amount's name": lambda t: step(t)["hostRequirements"].update(amounts=[{"name": "worker.vcpu", "min": 1}]),
        "an amount twice": lambda t: step(t)["hostRequirements"]["amounts"].append({"name": "Amount.Worker.VCPU".replace("A", "a", 1), "min": 1}),
        "an attribute without values": lambda t: step(t)["hostRequirements"].update(attributes=[{"name": "attr.worker.os.family", "anyOf": []}]),
        "a range": lambda t: space(t)[0].update(range="1 to 24"),
        "a range that nothing gives": lambda t: space(t)[0].update(range="{{Param.Range}}"),
        "a chunk without its extension": lambda t: (t.pop("extensions", None), space(t)[0].update(type="CHUNK[INT]", chunks={"defaultTaskCount": 1, "rangeConstraint": "CONTIGUOUS"})),
        "a chunk without its size": lambda t: (t.update(extensions=["TASK_CHUNKING"]), space(t)[0].update(type="CHUNK[INT]", chunks={"rangeConstraint": "CONTIGUOUS"})),
        "chunks that are none": lambda t: space(t)[0].update(type="INT", chunks={"defaultTaskCount": 1, "rangeConstraint": "CONTIGUOUS"}),
        "another kind of cancelation": lambda t: action(t).update(cancelation={"mode": "NOTIFY"}),
        "a long notice": lambda t: action(t).update(cancelation={"mode": "NOTIFY_THEN_TERMINATE", "notifyPeriodInSeconds": 601}),
        "no command": lambda t: action(t).pop("command"),
        "a number as an argument": lambda t: action(t)["args"].append(1),
        "a task parameter that is none": lambda t: action(t)["args"].append("{{Task.Param.Shot}}"),
        "a file that is none": lambda t: action(t)["args"].append("{{Task.File.Script}}"),
        "a file in a folder": lambda t: step(t)["script"]["embeddedFiles"][0].update(filename="a/b.sh"),
    }


def undetected(template, schema):
    for name, put in faults().items():
        faulty = copy.deepcopy(template)
        put(faulty)
        try:
            check(faulty, schema)
        except (ValueError, jsonschema.ValidationError):
            continue
        yield name


def resolve(text, values):
    return REFERENCE.sub(lambda match: values[match[1]], text)


def frames(text):
    """The numbers of a range expression, in ascending order."""
    numbers = set()
    for part in text.split(","):
        first, last, skip = re.fullmatch(r"\s*(-?\d+)(?:\s*-\s*(-?\d+))?(?::(\d+))?\s*", part).groups()
        numbers.update(range(int(first), int(last or first) + 1, int(skip or 1)))
    return sorted(numbers)


def chunks(numbers, size):
    """Contiguous ranges of at most `size` numbers, as a scheduler gives them to tasks."""
    while numbers:
        count = next((i for i in range(1, len(numbers)) if numbers[i] != numbers[i - 1] + 1), len(numbers))
        count = min(count, size)
        yield f"{numbers[0]}-{numbers[count - 1]}"
        numbers = numbers[count:]


def task_values(definition, values):
    numbers = frames(resolve(definition["range"], values))
    if definition["type"] == "INT":
        return [str(number) for number in numbers]
    return list(chunks(numbers, int(resolve(str(definition["chunks"]["defaultTaskCount"]), values))))


def run(template, folder, given):
    values = {f"Param.{p['name']}": str(given.get(p["name"], p.get("default", ""))) for p in template["parameterDefinitions"]}
    for step in template["steps"]:
        (definition,) = step["parameterSpace"]["taskParameterDefinitions"]
        for value in task_values(definition, values):
            known = values | {f"Task.Param.{definition['name']}": value}
            for file in step["script"]["embeddedFiles"]:
                path = pathlib.Path(folder) / file["filename"]
                known[f"Task.File.{file['name']}"] = str(path)
                path.write_text(resolve(file["data"], known), encoding="utf-8")
            action = step["script"]["actions"]["onRun"]
            command = [resolve(word, known) for word in [action["command"], *action["args"]]]
            print(step["name"], value, flush=True)
            subprocess.run(command, check=True)


def main(mode, *words):
    if mode == "run":
        run(load(words[0]), words[1], dict(word.split("=", 1) for word in words[2:]))
        return 0
    schema = load(words[0])
    for path in words[1:]:
        if mode == "check":
            check(load(path), schema)
        for name in undetected(load(path), schema) if mode == "faults" else ():
            raise ValueError(f"{path}: the check does not find this fault: {name}")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(*sys.argv[1:]))
    except (ValueError, jsonschema.ValidationError, subprocess.CalledProcessError) as error:
        sys.exit(f"openjd_template: {getattr(error, 'message', error)}")
