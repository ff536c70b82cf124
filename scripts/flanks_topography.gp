# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Maps and surfaces of one or two flanks; scripts/flanks sets the variables used here before it loads this file.

load 'flanks_style.gp'

height = 130 + 540 * rows
from_top(y) = 1.0 - 1.0 * y / height # pixels of the png
file(kind, i, suffix) = kind . '_' . i . '.' . suffix
number_at = 24 # point of a contour line where its number stands
step = 1.0 / (fine_nodes - 1)
number(name, i) = value(name . '_' . i) # a variable of one row

# Contour lines, once for both formats: where material is missing, the nominal flank, where it is added.
set contour base
unset surface
do for [i = 1:rows] {
    step_um = number('step', i)
    set zrange [-number('range', i):number('range', i)]
    do for [kind = -1:1] {
        if (kind == 0) {
            set cntrparam levels discrete 0
        } else {
            set cntrparam levels incremental kind * step_um, kind * step_um, kind * number('range', i)
        }
        set table file('contour', i, kind + 1)
        splot file('map', i, 'bin') binary array=(fine_nodes, fine_nodes) format='%float32' endian=little \
            origin=(0, 0, 0) dx=step dy=step
        unset table
        # Never without a line that is long enough for a number, which gnuplot would complain of: one outside.
        set print file('contour', i, kind + 1) append
        print ''
        do for [point = 0:number_at] {
            print '2 2 0'
        }
        unset print
    }
}
unset contour
set surface

set style textbox opaque noborder fillcolor '#ffffff' margins 0.4,0.4
set palette maxcolors 0
unset key

do for [format in formats] {
    eval terminal(format, 'flanks_topography', 1400, height)
    set output picture . '.' . format
    set multiplot
    set label 1 title_text at screen 0.025, screen from_top(40) left font ',17' noenhanced
    set label 2 subtitle_text . \
        '; + material added; contour lines at the ticks of the scale: dashed -, thick 0, thin +' \
        at screen 0.025, screen from_top(80) left font ',11' textcolor rgb grey noenhanced

    do for [i = 1:rows] {
        top = 110 + 540 * (i - 1)
        range_um = number('range', i)
        step_um = number('step', i)
        set cbrange [-range_um:range_um]
        set label 3 number('title', i) at screen 0.025, screen from_top(top + 22) left font ',14'
        set label 4 number('numbers', i) at screen 0.445, screen from_top(top + 22) right font ',11' \
            textcolor rgb grey

        set lmargin at screen 0.09
        set rmargin at screen 0.445
        set tmargin at screen from_top(top + 55)
        set bmargin at screen from_top(top + 455)
        set border 15 lw 1.2
        set xrange [0:1]
        set yrange [0:1]
        set xtics 0.25 offset 0,0 format '%g'
        set ytics 0.25 offset 0,0 format '%g'
        set xlabel 't1, along the face (z / face width)' norotate offset 0,0
        set ylabel 't2, along the profile (0 start, 1 tip)' rotate offset 0.5,0
        unset zlabel
        unset colorbox
        plot file('map', i, 'bin') binary array=(fine_nodes, fine_nodes) format='%float32' endian=little \
                origin=(0, 0) dx=step dy=step with image, \
            file('contour', i, 0) using 1:2 with lines lw 1.2 dt (10,6) lc rgb '#202020', \
            file('contour', i, 2) using 1:2 with lines lw 1.2 lc rgb '#202020', \
            file('contour', i, 1) using 1:2 with lines lw 2.2 lc rgb '#202020', \
            for [kind = 0:2] file('contour', i, kind) using 1:2:(sprintf('%g', $3)) every ::number_at::number_at \
                with labels boxed font ',9'
        unset label 1
        unset label 2
        unset label 3
        unset label 4

        set margins 0, 0, 0, 0
        set origin 0.475, from_top(top + 520)
        set size 0.44, 540.0 / height
        set view 62, 325, 1.02, 1.15
        set zrange [number('low', i):number('high', i)]
        set xyplane at number('low', i)
        set border 127 + 256 + 512 lw 0.8
        set xtics 0.5 offset 0,-0.3
        set ytics 0.5 offset 0,-0.3
        set ztics step_um format '%g'
        set xlabel 't1, face' offset 0,-0.5
        set ylabel 't2, profile' offset 0,-0.5
        set zlabel 'deviation' . um rotate offset 1.1,0
        set grid ztics lt 1 lw 0.6 lc rgb '#cccccc'
        set pm3d depthorder border lc rgb '#404040' lw 0.3
        set colorbox user origin screen 0.91, screen from_top(top + 455) size screen 0.016, screen 400.0 / height
        set cbtics step_um format '%g'
        set cblabel 'deviation' . um offset 0.3,0
        splot file('surface', i, 'dat') using 1:2:3 with pm3d
        unset grid
        unset cblabel
        set origin 0, 0
        set size 1, 1
    }
    unset multiplot
    unset output
}
