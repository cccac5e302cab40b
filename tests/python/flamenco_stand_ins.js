// Stand-ins for what Flamenco Manager gives a job type; prints the tasks of the job in the first argument as JSON.
const fs = require("fs"), vm = require("vm"), path = require("path");

const expand = (frames) => frames.split(",").flatMap((part) => {
    const [first, last] = part.trim().split("-").map(Number);
    return Array.from({ length: (last || first) - first + 1 }, (_, i) => first + i);
});
const merge = (numbers) => {
    const runs = [];
    for (const n of numbers) {
        const run = runs[runs.length - 1];
        if (run && n === run[run.length - 1] + 1) run.push(n); else runs.push([n]);
    }
    return runs.map((run) => run.length > 2 ? `${run[0]}-${run[run.length - 1]}` : run.join(",")).join(",");
};
const flamenco = {
    path: path.posix,
    author: {
        Task: (name, type) => ({ name, type, commands: [], addCommand(command) { this.commands.push(command); } }),
        Command: (name, parameters, steps) => ({ name, parameters, steps }),
    },
    frameChunker: (frames, size) => {
        const numbers = expand(frames), chunks = [];
        for (let i = 0; i < numbers.length; i += size) chunks.push(merge(numbers.slice(i, i + size)));
        return chunks;
    },
    frameCount: (frames) => expand(frames).length,
    shellSplit: (text) => (text.match(/"[^"]*"|'[^']*'|\S+/g) || []).map((word) => word.replace(/^["']|["']$/g, "")),
};
const [script, settings] = process.argv.slice(2);
const context = vm.createContext(flamenco);
vm.runInContext(fs.readFileSync(script, "utf8") + "\nthis.type = JOB_TYPE;", context);
const tasks = [];
context.compileJob({ settings: JSON.parse(settings), addTask: (task) => tasks.push(task) });
console.log(JSON.stringify({ type: context.type, tasks }));
