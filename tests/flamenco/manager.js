// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// node manager.js JOB_TYPE.js SETTINGS.json: compiles a job as Flamenco 3's Manager does, and prints its tasks.
//
// The Manager's API for job types, and no more of it: what is not there, a setting that is not given, and what the
// Manager or a worker would refuse, are errors.
"use strict";

const fs = require("fs");
const vm = require("vm");

const TASK_TYPES = ["blender", "ffmpeg", "file-management", "misc"];
const SETTING_TYPES = { string: "string", int32: "number", float: "number", bool: "boolean" };
const SETTING_KEYS = [
    ...["key", "type", "subtype", "choices", "propargs", "description", "label", "default", "eval", "evalInfo"],
    ...["visible", "required", "editable"],
];
const SUBTYPES = ["file_path", "dir_path", "hashed_file_path"];
const VISIBLE = ["visible", "hidden", "submission", "web"];

function must(isTrue, text) {
    if (!isTrue) throw new Error(text);
}

// An object whose unknown members are errors when they are read, set or removed.
function strict(name, members) {
    const known = (key) => must(typeof key === "symbol" || key in members, `${name} has no ${String(key)}`);
    return new Proxy(members, {
        get: (target, key) => (known(key), target[key]),
        set: (target, key, value) => (known(key), (target[key] = value), true),
        deleteProperty: (_, key) => must(false, `${name}.${String(key)} is removed`),
    });
}

// frameChunker of the Manager: frames once each and in order; two neighbors are written with a comma.
function frameChunker(range, size) {
    must(typeof range === "string" && range.trim() !== "", "empty range");
    must(Number.isInteger(size) && size >= 1, `invalid chunk size ${size}`);
    const frames = new Set();
    for (const part of range.replaceAll("..", "-").split(",")) {
        const ends = part.split("-").map((text) => text.trim());
        must(ends.length <= 2 && ends.every((text) => /^\d+$/.test(text)), `invalid range "${part}"`);
        for (let frame = Number(ends[0]); frame <= Number(ends[ends.length - 1]); ++frame) frames.add(frame);
    }
    const list = [...frames].sort((a, b) => a - b);
    must(list.length > 0, "empty range");
    const chunks = [];
    for (let at = 0; at < list.length; at += size) chunks.push(merged(list.slice(at, at + size)));
    return chunks;
}

function merged(frames) {
    const runs = [];
    for (const frame of frames) {
        const run = runs[runs.length - 1];
        if (run && run[1] + 1 === frame) run[1] = frame;
        else runs.push([frame, frame]);
    }
    return runs.map(([a, b]) => (a === b ? `${a}` : a + 1 === b ? `${a},${b}` : `${a}-${b}`)).join(",");
}

const author = strict("author", {
    Task(name, type, ...more) {
        must(typeof name === "string" && name !== "", "a task has no name");
        must(TASK_TYPES.includes(type) && more.length === 0, `task ${name} is of no type that workers take: ${type}`);
        const inner = { name, type, commands: [], dependencies: [] };
        tasks.set(
            strict("a task", {
                addCommand: (command) => {
                    must(commands.has(command), "what is added is no command");
                    inner.commands.push(commands.get(command));
                },
                addDependency: (task) => {
                    must(tasks.has(task), "a dependency is no task");
                    inner.dependencies.push(tasks.get(task));
                },
            }),
            inner,
        );
        return [...tasks.keys()].pop();
    },
    Command(name, parameters, ...more) {
        must(name === "exec" && more.length === 0, `workers know no command ${name} as it is meant here`);
        const { exe, args, ...others } = parameters;
        must(typeof exe === "string" && exe !== "", "exec takes a string exe");
        must(Array.isArray(args) && args.every((item) => typeof item === "string"), "exec takes strings as args");
        must(Object.keys(others).length === 0, `exec takes no ${Object.keys(others)}`);
        const command = strict("a command", {});
        commands.set(command, { name, exe, args: [...args] });
        return command;
    },
});
const tasks = new Map();
const commands = new Map();

function checkType(jobType) {
    const { label, description, settings, ...others } = jobType;
    must(label && typeof label === "string", "the job type has no label");
    must(description === undefined || typeof description === "string", "the description is no text");
    must(Object.keys(others).length === 0, `a job type has no ${Object.keys(others)}`);
    const seen = new Set();
    for (const item of settings) {
        for (const key of Object.keys(item)) must(SETTING_KEYS.includes(key), `settings have no ${key}`);
        must(/^[a-z_]+$/.test(item.key) && !seen.has(item.key), `the key ${item.key} is wrong or there twice`);
        seen.add(item.key);
        must(item.type in SETTING_TYPES, `${item.key} has the type ${item.type}`);
        must(item.subtype === undefined || SUBTYPES.includes(item.subtype), `${item.key}: ${item.subtype}`);
        must(item.visible === undefined || VISIBLE.includes(item.visible), `${item.key}: ${item.visible}`);
        must(item.evalInfo === undefined || typeof item.eval === "string", `${item.key} has nothing to evaluate`);
        const is = (value) => typeof value === SETTING_TYPES[item.type];
        must(item.default === undefined || is(item.default), `the default of ${item.key} is no ${item.type}`);
        must(!item.choices || (item.type === "string" && item.choices.every(is)), `choices of ${item.key}`);
        must(!item.choices || item.choices.includes(item.default), `the default of ${item.key} is no choice`);
    }
}

function settingsOf(jobType, given) {
    const values = {};
    for (const item of jobType.settings) {
        const value = given[item.key] ?? item.default;
        must(value !== undefined || !item.required, `the setting ${item.key} is not given`);
        must(value === undefined || typeof value === SETTING_TYPES[item.type], `${item.key} is no ${item.type}`);
        if (value !== undefined) values[item.key] = value;
    }
    for (const key of Object.keys(given)) must(key in values, `the job type has no setting ${key}`);
    return values;
}

function compile(file, given) {
    const silent = () => {};
    const globals = { author, frameChunker, print: silent, alert: silent };
    const context = vm.createContext(globals);
    const source = fs.readFileSync(file, "utf-8");
    vm.runInContext(`"use strict";${source}\nglobalThis.found = { JOB_TYPE, compileJob };`, context, { filename: file });
    const { JOB_TYPE, compileJob } = context.found;
    checkType(JOB_TYPE);
    const added = [];
    const addTask = (task) => {
        must(tasks.has(task) && !added.includes(task), "what is added is no task, or there already");
        added.push(task);
    };
    compileJob(strict("the job", { settings: strict("settings", settingsOf(JOB_TYPE, given)), addTask }));
    const list = added.map((task) => tasks.get(task));
    for (const task of list) {
        must(task.commands.length > 0, `${task.name} has no command`);
        for (const other of task.dependencies) must(list.includes(other), `${task.name} waits for what is not in the job`);
    }
    const named = list.map((task) => ({ ...task, dependencies: task.dependencies.map((other) => other.name) }));
    return { settings: JOB_TYPE.settings, tasks: named };
}

try {
    console.log(JSON.stringify(compile(process.argv[2], JSON.parse(process.argv[3]))));
} catch (error) {
    console.error(error.message ?? String(error));
    process.exit(1);
}
