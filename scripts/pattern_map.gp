# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Line load and pressure over the flank of each gear; scripts/pattern sets the variables used here.

load 'style.gp'

gear(i) = value(sprintf('gear_%d', i))
low(i) = value(sprintf('low_%d', i))
high(i) = value(sprintf('high_%d', i))
root(i) = value(sprintf('root_%d', i))
tip(i) = value(sprintf('tip_%d', i))
name(k) = value(sprintf('name_%d', k))
unit(k) = value(sprintf('unit_%d', k))
note(k) = value(sprintf('note_%d', k))
step(k) = value(sprintf('step_%d', k))
top(k) = value(sprintf('top_%d', k))
file(kind, i, k) = sprintf('%s_%d_%d', kind, i, k)
dx = (z_high - z_low) / (nodes - 1.0)
dy(i) = (high(i) - low(i)) / (nodes - 1.0)

# Contour lines, once for all formats.
set contour base
unset surface
do for [i = 0:1] {
    do for [k = 0:1] {
        set cntrparam levels incremental step(k), step(k), top(k)
        set table file('contours', i, k)
        splot file('values', i, k) . '.bin' binary array=(nodes, nodes) format='%float32' endian=little \
            origin=(z_low, low(i), 0) dx=dx dy=dy(i)
        unset table
        # Never without a line, of which gnuplot would complain: one outside.
        set print file('contours', i, k) append
        print ''
        print sprintf('%g %g 0', z_low - 1e6, low(i))
        unset print
    }
}
unset contour
set surface

set palette @palette_of_steps negative
set palette maxcolors 0
set xrange [z_low:z_high]
unset key

do for [format in formats] {
    eval terminal(format, 'pattern_map', 1400, 1100)
    set output picture . '.' . format
    set multiplot
    set label 1 title_text at screen 0.025, screen 0.965 left font ',17' noenhanced
    set label 2 subtitle_text . '; largest of all positions; lines at the ticks of the scale; dashed: active flank' \
        at screen 0.025, screen 0.93 left font ',11' textcolor rgb grey noenhanced
    do for [k = 0:1] {
        do for [i = 0:1] {
            left = 0.085 + 0.5 * k
            above = 0.865 - 0.43 * i
            set lmargin at screen left
            set rmargin at screen left + 0.31
            set tmargin at screen above
            set bmargin at screen above - 0.33
            set yrange [root(i):tip(i)]
            set cbrange [0:top(k)]
            set colorbox user origin screen left + 0.322, screen above - 0.33 size screen 0.014, screen 0.33
            set cbtics step(k) format '%g'
            set cblabel name(k) . ' / (' . unit(k) . ')' offset 0.4,0 noenhanced
            set xlabel (i == 1 ? 'z / mm, from face I (left) to face II' : '') offset 0,0.3
            set ylabel 'diameter / mm, from root to tip' offset 0,0
            set label 3 gear(i) . ', ' . name(k) at graph 0, graph 1.045 left font ',13'
            set label 4 note(k) at graph 1, graph 1.045 right font ',11' textcolor rgb grey noenhanced
            set arrow 1 from z_low, low(i) to z_high, low(i) nohead front dt (8,5) lw 1 lc rgb grey
            set arrow 2 from z_low, high(i) to z_high, high(i) nohead front dt (8,5) lw 1 lc rgb grey
            plot file('colours', i, k) . '.bin' binary array=(nodes, nodes) format='%float32' endian=little \
                    origin=(z_low, low(i)) dx=dx dy=dy(i) with image, \
                file('contours', i, k) using 1:2 with lines lw 1 lc rgb '#202020'
            unset label 1
            unset label 2
        }
    }
    unset multiplot
    unset output
}
