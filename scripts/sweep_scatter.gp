# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Numbers of all runs over each key that was drawn at random; scripts/sweep sets the variables used here before it loads
# this file.

load 'style.gp'

width = 295 + 330 * columns
height = 220 + 300 * panels
edge = 165.0 / width
upper = 1.0 - 120.0 / height
bottom = 90.0 / height
across = (1.0 - edge - 25.0 / width) / columns
down = (upper - bottom) / panels
set border 3
set grid lt 1 lw 0.6 lc rgb '#e4e4e4'
unset key

do for [format in formats] {
    eval terminal(format, 'sweep_scatter', width, height)
    set output picture . '.' . format
    set multiplot
    set label 1 title_text at screen 0.025, screen 1 - 35.0 / height left font ',17' noenhanced
    set label 2 sprintf('%d runs', runs) at screen 0.025, screen 1 - 75.0 / height left font ',12' textcolor rgb grey
    do for [p = 0:panels - 1] {
        do for [c = 0:columns - 1] {
            set lmargin at screen edge + c * across + (c > 0 ? 55.0 / width : 0)
            set rmargin at screen edge + (c + 1) * across
            set tmargin at screen upper - p * down
            set bmargin at screen upper - (p + 1) * down + 40.0 / height
            set ylabel (c == 0 ? value(sprintf('panel_%d', p)) : '') noenhanced
            set xlabel (p == panels - 1 ? value(sprintf('key_%d', c)) : '') noenhanced
            set format y (c == 0 ? '%g' : '')
            set xtics value(sprintf('tics_%d', c))
            set format x (p == panels - 1 ? value(sprintf('format_%d', c)) : '')
            set yrange [value(sprintf('low_%d', p)):value(sprintf('high_%d', p))]
            set xrange [value(sprintf('from_%d', c)):value(sprintf('to_%d', c))]
            plot 'scatter.dat' using c + 1:columns + p + 1 with points pt 7 ps 0.6 lc rgb pinion_colour
            unset label 1
            unset label 2
        }
    }
    unset multiplot
    unset output
}
