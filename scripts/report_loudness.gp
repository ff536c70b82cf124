# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Loudness and sharpness of the sound of a run; scripts/report sets the variables used here.

load 'style.gp'

set border 3
set grid xtics ytics lt 1 lw 0.6 lc rgb '#d8d8d8'
unset key
set xrange [along_low:along_high]

do for [format in formats] {
    eval terminal(format, 'report_loudness', 1400, 950)
    set output picture . '.' . format
    set multiplot
    set lmargin at screen 0.105
    set rmargin at screen 0.965
    set tmargin at screen 0.86
    set bmargin at screen 0.52
    set yrange [0:loudness_high]
    set format x ''
    unset xlabel
    set ylabel 'loudness / sone'
    set label 1 title_text at screen 0.025, screen 0.962 left font ',17' noenhanced
    set label 2 subtitle_text at screen 0.025, screen 0.917 left font ',12' textcolor rgb grey noenhanced
    plot 'loudness.dat' using 1:2 with lines lw 1.4 lc rgb colour_of(0)

    unset label 1
    unset label 2
    set tmargin at screen 0.46
    set bmargin at screen 0.115
    set yrange [0:sharpness_high]
    set format x '%g'
    set xlabel (over_time ? 'time / s' : 'pinion speed / rpm')
    set ylabel 'sharpness / acum'
    plot 'loudness.dat' using 1:3 with lines lw 1.4 lc rgb colour_of(1)
    unset multiplot
    unset output
}
