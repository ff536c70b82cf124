# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Order map of one run over that of another one, in dB; scripts/plot sets the variables.

load 'flanks_style.gp'

set lmargin at screen 0.105
set rmargin at screen 0.835
set tmargin at screen 0.80
set bmargin at screen 0.115
set xrange [0:edge]
set yrange [row_low:row_high]
set cbrange [-reach:reach]
set xlabel 'order'
set ylabel 'pinion speed / rpm'
set cblabel 'difference / dB' offset 0.6,0
set colorbox user origin screen 0.89, screen 0.115 size screen 0.022, screen 0.685
set mxtics 2
set mytics 2
unset key
set label title_text at screen 0.025, screen 0.965 left font ',17' noenhanced
set label subtitle_text at screen 0.025, screen 0.93 left font ',11' textcolor rgb grey noenhanced
load 'rim.gp'
row_height = 1.0 * (row_high - row_low) / rows

do for [format in formats] {
    eval terminal(format, 'plot_difference', 1400, 1000)
    set output picture . '.' . format
    plot 'difference.bin' binary array=(columns, rows) format='%float32' endian=little \
        origin=(order_step / 2, row_low + row_height / 2) dx=order_step dy=row_height with image
    unset output
}
