# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Lines of contact on the pinion's flank at some positions, and the line load along them; scripts/pattern sets the
# variables used here.

load 'style.gp'

of(name, i) = value(sprintf('%s_%d', name, i))
row = 290.0
pixels = 160 + row * positions
from_top(y) = 1.0 - y / pixels

# The lightest colours are not seen as lines on white.
set palette @palette_of_steps negative
set palette maxcolors 0
set xrange [z_low:z_high]
set cbrange [-0.25 * top:top]

do for [format in formats] {
    eval terminal(format, 'pattern_lines', 1400, pixels)
    set output picture . '.' . format
    set multiplot
    set label 1 title_text at screen 0.025, screen from_top(40) left font ',17' noenhanced
    set label 2 subtitle_text . '; lines of contact and the load along them' at screen 0.025, screen from_top(76) left \
        font ',11' textcolor rgb grey noenhanced
    do for [i = 0:positions - 1] {
        set tmargin at screen from_top(130 + row * i)
        set bmargin at screen from_top(130 + row * (i + 1) - 65)
        last = i == positions - 1
        set xlabel (last ? 'z / mm, from face I (left) to face II' : '') offset 0,0.3
        set format x (last ? '%g' : '')

        # Where the lines are.
        set lmargin at screen 0.085
        set rmargin at screen 0.47
        set border 15
        set yrange [root:tip]
        set ytics auto
        set ylabel 'diameter / mm' offset 0,0
        set label 3 sprintf('%.3g mesh cycles', of('cycle', i)) at graph 0, graph 1.07 left font ',12'
        set arrow 1 from z_low, low to z_high, low nohead dt (8,5) lw 1 lc rgb grey
        set arrow 2 from z_low, high to z_high, high nohead dt (8,5) lw 1 lc rgb grey
        unset key
        unset colorbox
        plot for [block = of('first', i):of('last', i)] 'lines.dat' index block using 1:2 with lines lw 1.5 dt 1 \
            lc rgb '#909090', \
            for [block = of('first', i):of('last', i)] 'lines.dat' index block using 1:($3 > 0 ? $2 : NaN):3 \
            with lines lw 6 lc palette
        unset label
        unset arrow

        # What they carry.
        set lmargin at screen 0.56
        set rmargin at screen 0.88
        set border 3
        set yrange [0:top * 1.04]
        set ytics step
        set ylabel 'line load / (N/mm)' offset 0,0
        set key at screen 0.99, screen from_top(130 + row * i) right top samplen 1.5 font ',11' noenhanced
        plot for [block = of('first', i):of('last', i)] 'lines.dat' index block using 1:3 with linespoints lw 1.8 pt 7 \
            ps 0.5 lc rgb colour_of(block - of('first', i)) dt dash_of(block - of('first', i)) title of('label', block)
    }
    unset multiplot
    unset output
}
