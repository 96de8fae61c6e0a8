#!/bin/sh
# The layer rule over #include lines: layers.sh SOURCE_ROOT. Prints each offence, fails when there is one.
cd "$1" || exit 2
grep -rEHn '^[ \t]*#[ \t]*include' --include='*.[ch]' --include='*.cpp' --include='*.hpp' \
    sdk stages plugins bindings | sed -E 's/[ \t]*#[ \t]*include[ \t]*//' | awk -F: '
BEGIN {
    may["base"] = "base"; may["sparse"] = "base sparse"; may["mesh"] = "base mesh"
    may["shape"] = "base sparse mesh shape"; may["cover"] = "base sparse mesh cover"
    may["dec"] = may["cover"] " dec"; may["field"] = may["dec"] " field"; may["optimize"] = may["field"] " optimize"
    may["map"] = may["optimize"] " map"; may["finish"] = "base mesh finish"
    may["pipeline"] = "base pipeline"; may["remesh"] = may["map"] " finish shape pipeline remesh"
    may["qc"] = may["remesh"] " qc"   # the umbrella header
}
# The layer a public header or a folder of sdk/ belongs to.
function layer(path) {
    sub(/.*\//, "", path); sub(/\.h$/, "", path)
    if (path == "solver") return "sparse"
    if (path == "closest_point" || path == "ray") return "mesh"
    return path == "stage" || path == "stages" || path == "plugin" ? "pipeline" : path
}
function offence(why) { print $1 ":" $2 ": " $3 " - " why; bad = 1 }
{
    split($1, at, "/"); name = substr($3, 2)
    sub(/[>"].*/, "", name)
    target = name ~ /^qc\// ? layer(name) : name ~ /^sdk\// ? (split(name, t, "/") ? t[2] : "") : ""
    if (at[1] == "sdk") {
        own = at[2] == "include" ? layer($1) : at[2]
        if (target != "" && (" " may[own] " ") !~ (" " target " ")) offence(own " may use: " may[own])
        if (name ~ /^(stages|plugins|bindings)\//) offence("sdk knows none of these")
    } else if (at[1] == "stages") {
        if (name ~ /^(plugins|bindings)\//) offence("stages use sdk only")
        if (name ~ /^stages\// && at[3] != "" && name !~ ("^stages/" at[2] "/"))
            offence("stages never use each other")
    } else if (name ~ /^(sdk|stages|plugins|bindings)\// && name !~ ("^" at[1] "/" at[2] "/"))
        offence("only qc/*.h and its own folder from here")
    if (name == "jansson.h" && $1 !~ /^(sdk\/pipeline\/json\.c|sdk\/remesh\/stats\.c|plugins|bindings)/)
        offence("json.c and stats.c only")
    if (name == "dlfcn.h" && $1 != "sdk/pipeline/library_loader.c") offence("library_loader.c only")
}
END { exit bad }'
