# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The map of scripts/orders, which sets the variables used here before it loads this file. Lines are named above it, so
# that they hide nothing; within it stands the eigenfrequency only.

load 'style.gp'
set palette @palette_of_steps

set lmargin at screen 0.105
set rmargin at screen 0.835
set tmargin at screen 0.80
set bmargin at screen 0.105
set xrange [0:edge]
set yrange [row_low:row_high]
set cbrange [colour_low:colour_high]
set xlabel 'order'
set ylabel (over_time ? 'time / s' : speed_name . ' / rpm')
set cblabel map_text offset 0.6,0 noenhanced
set colorbox user origin screen 0.89, screen 0.105 size screen 0.022, screen 0.695
set format cb '%g'
set mxtics 2
set mytics 2
unset key

set label 1 title_text at graph 0, screen 0.965 left font ',17' noenhanced
set label 2 subtitle_text at graph 0, screen 0.93 left font ',11' textcolor rgb grey noenhanced
load 'rim.gp'

row_height = 1.0 * (row_high - row_low) / rows
if (eigenfrequency_is_shown) {
    set label sprintf('dashed: eigenfrequency f0 = %.5g Hz', eigenfrequency) at screen 0.985, screen 0.02 right \
        font ',10' textcolor rgb grey
}

do for [format in formats] {
    eval terminal(format, 'orders_map', 1400, 1000)
    set output picture . '.' . format
    plot 'map.bin' binary array=(columns, rows) format='%float32' endian=little \
            origin=(order_step / 2, row_low + row_height / 2) dx=order_step dy=row_height with image, \
        'eigenfrequency.dat' using 1:2 with lines lw 1.6 dt (8,5) lc rgb '#ffffff'
    unset output
}
