#!/bin/bash
# The examples of --help: every tool has some, the manual page has the same, and each runs as shown.
. "$(dirname "$0")/check.sh"
export PATH=$bin:$PATH

traced fence 160x90
rm view_2.exr view_3.exr # the examples have two
cp rays_1.exr another.exr
cp view_0.exr right.exr
cp view_1.exr left.exr
cp center.exr beauty.exr
for view in center view_0 view_1; do cp $view.exr smooth.$view.exr; done
cp ldi.exr front.exr
cp ldi.exr back.exr
cp ldi.exr deep.exr
dof-gather ldi.exr -o picture.exr
for frame in 0001 0002 0003; do for name in picture rays_1 rays_2; do cp $name.exr $name.$frame.exr; done; done
dof-gather ldi.exr -o pull.####.exr --frames 1-3 --focus-distance 1:2.0,3:5.0

# Tools that take long, do not end, need a plate or USD's library have their own scripts.
elsewhere='^dof-(match|report|view) |\.usd'
ran=0
for tool in "$bin"/dof-* "$bin"/ldi-*; do
    name=$(basename "$tool")
    "$tool" --help | sed -n '/^Examples:/,$p' | sed -n 's/^      //p' >commands
    [ -s commands ] || fail "$name --help shows no example"
    grep -Ev "(^| )$name " commands && fail "these examples of $name do not use it"
    manual=$bin/../share/man/man1/$name.1
    [ -e "$manual" ] || manual=commands # options.sh asks for it
    sed 's/\\//g' "$manual" >page
    while IFS= read -r command; do
        grep -qF -e "${command%%|*}" page || fail "the manual page of $name lacks: $command"
        [[ $command =~ $elsewhere ]] && continue
        mkdir run
        cp -- *.exr run
        (cd run && bash -ec "$command" >said 2>&1) || fail "$command: $(cat run/said)"
        rm -r run
        ran=$((ran + 1))
    done <commands
done
[ "$ran" -ge 15 ] || fail "only $ran examples were run"
