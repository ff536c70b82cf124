# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# All flanks of a gear as small maps, and their numbers tooth by tooth; scripts/flanks sets the variables used here
# before it loads this file.

load 'flanks_style.gp'

data = 'strip.dat'
tile = 1235.0 / columns # pixels of the png
panel = tile_rows * tile * 1.25
height = 500 + 2 * (panel + 50)
from_top(y) = 1.0 - 1.0 * y / height
set cbrange [-range_um:range_um]
set style fill solid noborder

do for [format in formats] {
    eval terminal(format, 'flanks_teeth', 1400, height)
    set output picture . '.' . format
    set multiplot
    set lmargin at screen 0.025
    set rmargin at screen 0.025 + 1235.0 / 1400
    unset key
    unset border
    unset tics
    set xrange [0:image_width]
    set yrange [0:image_height]
    set label 1 title_text at screen 0.025, screen from_top(38) left font ',17' noenhanced
    set label 2 subtitle_text . '; each flank: t1 to the right, t2 upwards' at screen 0.025, screen from_top(76) \
        left font ',11' textcolor rgb grey noenhanced
    set colorbox user origin screen 0.925, screen from_top(100 + 2 * (panel + 50)) \
        size screen 0.016, screen (2 * panel + 50.0) / height
    set cbtics step_um format '%g' nomirror
    set cblabel 'deviation' . um . ' (+ material added)' offset 0.3,0
    top = 140
    do for [side in 'drive coast'] {
        set tmargin at screen from_top(top)
        set bmargin at screen from_top(top + panel)
        set label 3 side . ' flanks' at screen 0.025, screen from_top(top - 20) left font ',14' \
            textcolor rgb value(side . '_colour')
        plot 'tiles_' . side . '.bin' binary array=(image_width, image_height) format='%float32' \
                endian=little origin=(0.5, 0.5) dx=1 dy=1 with image, \
            'tile_texts.dat' using 1:2:(sprintf('%d', $3)) with labels font (columns > 20 ? ',7' : ',8') \
                textcolor rgb grey
        unset label 1
        unset label 2
        unset colorbox
        top = top + panel + 50
    }

    set border 3
    set xtics nomirror out format '%.0f'
    if (teeth <= 20) { set xtics 1 }
    set errorbars 0
    set ytics nomirror out format '%g'
    set lmargin at screen 0.085
    set rmargin at screen 0.975
    set tmargin at screen from_top(top + 10)
    set bmargin at screen 90.0 / height
    set xrange [-0.7:teeth - 0.3]
    set yrange [*:*]
    if (flat) { set yrange [-range_um:range_um] }
    set xzeroaxis lt 1 lw 1.0 lc rgb '#606060'
    set grid ytics lt 1 lw 0.6 lc rgb '#d0d0d0'
    set label 3 'Round the gear' at screen 0.025, screen from_top(top - 20) textcolor rgb '#000000'
    set xlabel 'tooth'
    set ylabel 'deviation' . um
    set key at screen 0.975, screen from_top(top - 18) right horizontal samplen 1.5 font ',12'
    plot data using ($1 - 0.15):2:3:4 with yerrorbars pt 7 ps 0.7 lc rgb drive_colour title 'drive: mean, range', \
        data using ($1 + 0.15):6:7:8 with yerrorbars pt 5 ps 0.6 lc rgb coast_colour title 'coast: mean, range', \
        for [i = 1:has_pitch] data using 1:5 with lines lw 2.2 lc rgb drive_colour title 'drive: pitch', \
        for [i = 1:has_pitch] data using 1:9 with lines lw 2.2 dt (8,4) lc rgb coast_colour title 'coast: pitch'
    unset xlabel
    unset ylabel
    unset grid
    unset xzeroaxis
    unset multiplot
    unset output
}
