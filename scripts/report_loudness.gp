# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Loudness, sharpness and tonality of the sound of a run; scripts/report sets the variables used here.

load 'style.gp'

set border 3
set grid xtics ytics lt 1 lw 0.6 lc rgb '#d8d8d8'
unset key
set xrange [along_low:along_high]

do for [format in formats] {
    eval terminal(format, 'report_loudness', 1400, 1200)
    set output picture . '.' . format
    set multiplot
    set lmargin at screen 0.105
    set rmargin at screen 0.965
    set tmargin at screen 0.88
    set bmargin at screen 0.635
    set yrange [0:loudness_high]
    set format x ''
    unset xlabel
    set ylabel 'loudness / sone'
    set label 1 title_text at screen 0.025, screen 0.962 left font ',17' noenhanced
    set label 2 subtitle_text at screen 0.025, screen 0.917 left font ',12' textcolor rgb grey noenhanced
    plot 'loudness.dat' using 1:2 with lines lw 1.4 lc rgb colour_of(0)

    unset label 1
    unset label 2
    set tmargin at screen 0.61
    set bmargin at screen 0.365
    set yrange [0:sharpness_high]
    set ylabel 'sharpness / acum'
    plot 'loudness.dat' using 1:3 with lines lw 1.4 lc rgb colour_of(1)

    set tmargin at screen 0.34
    set bmargin at screen 0.095
    set yrange [0:tonality_high]
    set format x '%g'
    set xlabel (over_time ? 'time / s' : 'pinion speed / rpm')
    set ylabel 'tone-to-noise ratio / dB'
    if (tones > 0) {
        plot 'tonality.dat' using 1:2 with linespoints lw 1.4 pt 7 ps 0.6 lc rgb colour_of(2)
    } else {
        set label 3 'no tonality of a sound this short' at graph 0.5, graph 0.5 center textcolor rgb grey
        plot NaN
    }
    unset label 3
    unset multiplot
    unset output
}
