# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The map of scripts/campbell and scripts/orders, which set the variables used here before they load this file. Lines are
# marked at the rim only, so that they hide nothing; lines.py says where.

load 'style.gp'
set palette @palette_of_steps

set lmargin at screen 0.105
set rmargin at screen 0.835
set tmargin at screen 0.84
set bmargin at screen 0.105
set xrange [0:frequency_high]
set yrange [row_low:row_high]
set cbrange [colour_low:colour_high]
set xlabel 'frequency / Hz'
set ylabel (over_time ? 'time / s' : speed_name . ' / rpm')
set cblabel map_text offset 0.6,0 noenhanced
set colorbox user origin screen 0.89, screen 0.105 size screen 0.022, screen 0.735
if (is_level) { set format cb '%g' } else { set cbtics 0.5 format '%.1f' } # exponents of 10
set mxtics 2
set mytics 2
set format x '%g'
set format y '%g'
unset key

set label 1 title_text at graph 0, screen 0.96 left font ',17' noenhanced
set label 2 subtitle_text at graph 0, screen 0.925 left font ',11' textcolor '#505050' noenhanced

set label 3 rim_note . (eigenfrequency > 0 ? sprintf('%sf0 = eigenfrequency %.5g Hz', rim_note eq '' ? '' : ', ', \
    eigenfrequency) : '') at screen 0.985, screen 0.025 right font ',10' textcolor rgb grey

# Orders: the line goes on outside where it leaves the map, at the right or at the top.
do for [i = 0:marks - 1] {
    x = value(sprintf('mark_x_%d', i))
    y = value(sprintf('mark_y_%d', i))
    out_x = value(sprintf('mark_out_x_%d', i))
    out_y = value(sprintf('mark_out_y_%d', i))
    set arrow from graph x, graph y to graph out_x, graph out_y nohead lw 2
    if (x < 1) {
        set label value(sprintf('mark_text_%d', i)) at graph out_x, graph out_y center offset 0,0.6 font ',13'
    } else {
        set label value(sprintf('mark_text_%d', i)) at graph out_x, graph out_y left offset 0.4,0 font ',13'
    }
}

# Eigenfrequency: dashes above the map, and a few within it at the top and at the bottom.
if (eigenfrequency > 0 && eigenfrequency < frequency_high) {
    set arrow from first eigenfrequency, graph 1.055 to first eigenfrequency, graph 0.95 \
        nohead front lw 1.6 dt (8,5)
    set arrow from first eigenfrequency, graph 0 to first eigenfrequency, graph 0.05 \
        nohead front lw 1.6 dt (8,5)
    set label 'f0' at first eigenfrequency, graph 1.055 center offset 0,0.6 font ',13'
}

do for [format in formats] {
    eval terminal(format, 'campbell_map', 1400, 1000)
    set output picture . '.' . format
    plot data binary array=(columns, rows) format='%float32' endian=little \
        origin=(0, row_first) dx=frequency_step dy=row_step with image
    unset output
}
