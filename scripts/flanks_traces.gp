# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Profile and helix traces of some teeth, each on its nominal line, material added to the outside: drive (or left)
# flanks at the left, coast (or right) flanks at the right. scripts/flanks sets the variables used here before it loads this file.

load 'flanks_style.gp'

file(kind, name) = sprintf('%s_%s.dat', kind, name)
width = gap + slots
left = 0.085
right = 0.975
height = 1440
from_top(y) = 1.0 - 1.0 * y / height # pixels of the png
set xrange [-width:width]
set yrange [0:1]
unset xtics
set border 0
unset key
half(side, x) = side eq 'drive' ? -x : x

do for [format in formats] {
    eval terminal(format, 'flanks_traces', 1400, height)
    set output picture . '.' . format
    set multiplot
    set lmargin at screen left
    set rmargin at screen right
    do for [kind in 'profile helix'] {
        top = kind eq 'profile' ? 215 : 890
        set tmargin at screen from_top(top)
        set bmargin at screen from_top(top + 420)
        unset label
        unset arrow
        if (kind eq 'profile') {
            set label title_text at screen 0.025, screen from_top(40) left font ',17' noenhanced
            set label subtitle_text at screen 0.025, screen from_top(80) left font ',11' textcolor rgb grey noenhanced
        }
        eval 'set ytics (' . value(kind . '_tics') . ')'
        set label value(kind . '_title') at screen 0.025, screen from_top(top - 85) left font ',14'
        heading = top - 35
        set label '← + material     ' . left_flanks . ' flanks' at first -0.5 * slots - gap, screen from_top(heading) center \
            font ',12' textcolor rgb drive_colour
        set label right_flanks . ' flanks     + material →' at first 0.5 * slots + gap, screen from_top(heading) center \
            font ',12' textcolor rgb coast_colour
        bar = value(kind . '_bar')
        set arrow from first -bar / 2, screen from_top(heading + 18) to first bar / 2, screen from_top(heading + 18) \
            heads size screen 0.004, 90 lw 2
        set label value(kind . '_bar_text') at first 0, screen from_top(heading - 4) center font ',12'
        do for [line in value(kind . '_lines')] {
            rim = line eq '0' || line eq '1'
            set arrow from first -width, first line + 0 to first width, first line + 0 nohead back \
                lw (rim ? 1.0 : 0.5) lc rgb (rim ? '#909090' : '#d8d8d8')
        }
        set label "tooth\nrange\nslope\nform" at first 0, screen from_top(top + 448) center font ',11' textcolor rgb grey
        load kind . '_texts.gp' # numbers of each trace
        plot for [side in 'drive coast'] file(kind, side . '_area') using 1:2 with filledcurves closed \
                fs transparent solid 0.18 noborder lc rgb value(side . '_colour'), \
            file(kind, 'nominal') using 1:2 with lines lw 0.8 lc rgb '#606060', \
            for [side in 'drive coast'] file(kind, side) using 1:2 with lines lw 2 \
                lc rgb value(side . '_colour'), \
            for [n in (overlay ? 'yes' : '')] file(kind, 'all') using 1:2 with lines lw 0.5 lc rgb '#a0606060', \
            for [n in (overlay ? 'yes' : '')] file(kind, 'mean') using 1:2 with lines lw 2 lc rgb '#202020'
    }
    unset multiplot
    unset output
}
