# Draws published measurements and the results of steplap, for docs/evidence/experiments.md. Variables: figure, output, data (the folder
# tests/data/experiments), computed (output of print_experiments for this experiment).
set terminal svg size 640,360 font "sans,13" background "white"
set output output
set datafile separator ","
set datafile commentschars "#"
set grid lc rgb "#dddddd"
set key right top samplen 2
measured = "#8a8f98"; predicted = "#1f5fa8"; fitted = "#b35900"
bars(role, i) = (strcol(11) eq role) ? column(i) : NaN

if (figure eq "golf_ball" || figure eq "table_tennis_ball") {
  set xlabel "bounce"
  set ylabel "time to the next bounce, s"
  set xrange [0.5:8.5]
  set xtics 1
  if (figure eq "golf_ball") { heights = "0.8 0.9 1 1.1" } else { heights = "0.08 0.1 0.15 0.18 0.3"; set yrange [0.13:0.5] }
  plot computed skip 1 using 4:6:7 with yerrorbars pt 7 ps 0.4 lw 1.5 lc rgb measured title "measured, one standard deviation of a throw", \
       for [h in heights] computed skip 1 using 4:(strcol(3) eq h ? bars("predicted", 8) : NaN) with lines lw 2 lc rgb predicted \
         title (h eq word(heights, 1) ? "predicted" : ""), \
       for [h in heights] computed skip 1 using 4:(strcol(3) eq h ? bars("fitted", 8) : NaN) with lines lw 2 lc rgb fitted \
         title (h eq word(heights, words(heights)) ? "fitted" : "")
}
if (figure eq "flywheel_trolley") {
  set xlabel "run"
  set ylabel "time, s"
  set key center right
  set xrange [0:21]
  set yrange [1.4:2.2]
  free = system("sed -n 2p ".computed." | cut -d, -f8") + 0.0
  locked = system("sed -n 3p ".computed." | cut -d, -f8") + 0.0
  plot data."/flywheel_trolley.csv" skip 1 using 1:2 with points pt 6 ps 0.6 lc rgb measured title "measured, flywheels free", \
       free with lines lw 2 lc rgb fitted title "fitted (slope)", \
       data."/flywheel_trolley.csv" skip 1 using 1:3 with points pt 7 ps 0.6 lc rgb measured title "measured, flywheels locked", \
       locked with lines lw 2 lc rgb predicted title "predicted"
}
if (figure eq "inclined_rail") {
  set ylabel "time, s"
  set xrange [0.4:5.6]
  set yrange [0.4:3.2]
  set xtics ("plastic cyl." 1, "metal cyl. 1" 2, "metal cyl. 2" 3, "metal ball" 4, "rubber ball" 5)
  set key right top
  do for [row = 2:10] {
    y = real(system("sed -n ".row."p ".computed." | cut -d, -f8"))
    if (row == 2) { set arrow from 4.75,y to 5.25,y nohead front lw 3 lc rgb predicted }
    if (row == 3) { set arrow from 3.75,y to 4.25,y nohead front lw 3 lc rgb fitted }
    if (row == 4) { set arrow from 3.75,y to 4.25,y nohead front lw 3 dt 2 lc rgb predicted }
    if (row > 4 && row % 2 == 1) { set arrow from (row - 3)/2 - 0.22,y to (row - 3)/2,y nohead front lw 3 lc rgb fitted }
    if (row > 4 && row % 2 == 0) { set arrow from (row - 4)/2,y to (row - 4)/2 + 0.22,y nohead front lw 3 lc rgb predicted }
  }
  plot data."/inclined_rail.csv" skip 1 using ($1 - 0.2 + 0.01*$2):3 with points pt 7 ps 0.35 lc rgb measured title "measured runs, in their order", \
       NaN with lines lw 3 lc rgb predicted title "predicted: rolling, and the last 20 runs from the first", \
       NaN with lines lw 3 dt 2 lc rgb predicted title "if the metal ball rolled, too", \
       NaN with lines lw 3 lc rgb fitted title "fitted: friction"
}
if (figure eq "air_track") {
  set xlabel "hanging mass, g"
  set ylabel "computed over measured - 1, %"
  set xrange [5:55]
  set yrange [-2:8]
  set key right center
  plot computed skip 1 using 3:(0):(100*$7/$6) with yerrorbars pt 0 lw 2 lc rgb measured title "one standard deviation of a run", \
       computed skip 1 using 3:(strcol(2) eq "from masses and way alone" ? 100*($8/$6 - 1) : NaN) with points pt 9 ps 1 lc rgb predicted \
         title "from masses and way alone", \
       computed skip 1 using 3:(strcol(2) eq "with offset and drag" ? 100*bars("fitted", 8)/$6 - 100 : NaN) with points pt 5 ps 0.9 lc rgb fitted title "fitted: offset and drag", \
       computed skip 1 using 3:(strcol(2) eq "with offset and drag" ? 100*bars("predicted", 8)/$6 - 100 : NaN) with points pt 7 ps 0.9 lc rgb predicted title "predicted with them"
}
if (figure eq "car_to_car") {
  set ylabel "change of speed, mph"
  set xrange [0.5:2.5]
  set yrange [2.5:5.2]
  set xtics ("struck car, 770 kg" 1, "striking car, 950 kg" 2)
  place(what) = what eq "struck car" ? 1 : 2
  plot computed skip 1 using (place(strcol(2)) + 0.5*($3 - 0.3)):($8/0.44704) with points pt 7 ps 0.9 lc rgb predicted \
         title "predicted, coefficient of restitution 0.2, 0.3, 0.4", \
       computed skip 1 using (place(strcol(2)) - 0.15):($6/0.44704):(0.05) with yerrorbars pt 5 ps 0.7 lc rgb measured title "measured, last digit"
}
if (figure eq "rocking_blocks") {
  set xlabel "height over width"
  set ylabel "share of Housner's ratio"
  set xrange [2:6]
  set yrange [0.6:1.05]
  set key left bottom
  plot 1 with lines lw 1.5 dt 2 lc rgb "black" title "Housner: a rigid block without rebound", \
       computed skip 1 using 3:6:7 with yerrorbars pt 5 ps 0.7 lc rgb measured title "measured (0.67: on rubber)", \
       computed skip 1 using ($3 + 0.05):(bars("fitted", 8)) with points pt 7 ps 0.9 lc rgb fitted title "fitted: stiffness of the base", \
       computed skip 1 using ($3 + 0.05):(bars("predicted", 8)) with points pt 7 ps 0.9 lc rgb predicted title "predicted"
}
if (figure eq "housner_limit") {
  set terminal svg size 640,420 font "sans,13" background "white"
  set xlabel "stiffness of a corner, N/m"
  set ylabel "largest of 4 impacts: |ratio/Housner - 1|"
  set logscale xy
  set format x "1e%T"
  set format y "1e%T"
  set xrange [5e5:2e9]
  set yrange [1e-5:10]
  set key outside bottom center maxrows 4
  largest(a, b, c, d) = (a > b ? a : b) > (c > d ? c : d) ? (a > b ? a : b) : (c > d ? c : d)
  plot for [i = 1:4] computed skip 1 using 3:($1 == 5 && $2 == real(word("0.02 0.1 0.3 1", i)) ? largest(abs($4 - 1), abs($5 - 1), abs($6 - 1), abs($7 - 1)) : NaN) \
         with linespoints lw 2 pt 7 ps 0.6 lc rgb word("#9fc3ea #5f95d0 #1f5fa8 #0b3563", i) title "height 5 w, damping ".word("0.02 0.1 0.3 1", i), \
       for [i = 1:4] computed skip 1 using 3:($1 == 2 && $2 == real(word("0.02 0.1 0.3 1", i)) ? largest(abs($4 - 1), abs($5 - 1), abs($6 - 1), abs($7 - 1)) : NaN) \
         with linespoints lw 2 dt 2 pt 5 ps 0.6 lc rgb word("#f0c090 #d98c3d #b35900 #6b3500", i) title "height 2 w, damping ".word("0.02 0.1 0.3 1", i)
}
if (figure eq "toppling_brick") {
  set xlabel "time, s"
  set ylabel "tilt, degrees"
  set xrange [0:0.55]
  set yrange [30:100]
  set key left top
  plot computed skip 1 using 1:($1 < 0.335 ? $2*180/pi : NaN) with lines lw 2 lc rgb predicted title "predicted", \
       data."/toppling_brick.csv" skip 1 using 1:(90) with linespoints pt 7 ps 0.8 lw 2 lc rgb measured title "measured: about 0.4 or 0.5 s"
}
