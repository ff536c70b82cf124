# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Numbers over a key that takes even values, a curve for each value of a second key; scripts/sweep sets the variables
# used here before it loads this file.

load 'style.gp'

height = 220 + 330 * panels
upper = 1.0 - 130.0 / height
bottom = 100.0 / height
step = (upper - bottom) / panels
set border 3
set grid ytics lt 1 lw 0.6 lc rgb '#d8d8d8'
if (tics ne '') { eval 'set xtics (' . tics . ')' } # at the values themselves where they are few
set style fill transparent solid 0.18 noborder
right = curves > 1 ? 0.83 : 0.97

do for [format in formats] {
    eval terminal(format, 'sweep_response', 1300, height)
    set output picture . '.' . format
    set multiplot
    set label 1 title_text at screen 0.025, screen 1 - 35.0 / height left font ',17' noenhanced
    set label 2 sprintf('%d runs', runs) . (spread ? ': mean, and from the lowest to the highest where other keys vary' : '') \
        at screen 0.025, screen 1 - 75.0 / height left font ',12' textcolor rgb grey
    do for [p = 0:panels - 1] {
        set lmargin at screen 0.125
        set rmargin at screen right
        set tmargin at screen upper - p * step
        set bmargin at screen upper - (p + 1) * step + 55.0 / height
        set ylabel value(sprintf('panel_%d', p)) noenhanced
        set xlabel (p == panels - 1 ? along : '') noenhanced
        if (p == 0 && curves > 1) {
            set key top left Left reverse samplen 2 spacing 1.4 noenhanced at screen 0.845, screen upper
            set label 3 curves_of at screen 0.975, screen 1 - 75.0 / height right font ',12' textcolor rgb grey noenhanced
        } else {
            unset key
        }
        set yrange [value(sprintf('low_%d', p)):value(sprintf('high_%d', p))]
        plot for [c = 0:(spread ? curves - 1 : -1)] 'response.dat' index p * curves + c using 1:3:4 with filledcurves \
                fc rgb colour_of(c) notitle, \
            for [c = 0:curves - 1] 'response.dat' index p * curves + c using 1:2 with linespoints lw 2.4 pt 7 ps 0.8 \
                lc rgb colour_of(c) title value(sprintf('curve_%d', c))
        unset label 1
        unset label 2
        unset label 3
    }
    unset multiplot
    unset output
}
