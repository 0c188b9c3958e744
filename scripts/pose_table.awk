# Prints poses.csv (second file) as a table, with the distance from the true poses.csv (first file).
# Columns are found by name, so that added ones do no harm. 80 columns wide.
FNR == 1 {
  ++file
  delete column
  for (i = 1; i <= NF; ++i) column[$i] = i
  if (file == 2) {
    print "Pose of the body in the world; rotation as axis times angle. sigma: the expected"
    print "3D error (1 sigma); off: the real one, against the truth of the recording."
    print ""
    print "            position [mm]                   rotation [deg]           off"
    print "frame     x       y       z  sigma       x       y       z  sigma     mm    deg"
  }
  next
}
file == 1 {
  true_x[$1] = $column["tx_mm"]; true_y[$1] = $column["ty_mm"]; true_z[$1] = $column["tz_mm"]
  true_qw[$1] = $column["qw"]; true_qx[$1] = $column["qx"]
  true_qy[$1] = $column["qy"]; true_qz[$1] = $column["qz"]
  next
}
{
  ++frames
  status = $column["status"]
  if (status != "ok") { printf "%4d  %s\n", $1, status; next }
  ++poses
  x = $column["tx_mm"]; y = $column["ty_mm"]; z = $column["tz_mm"]
  degrees = degrees_per_vector_part($column["qw"], length_of_vector_part())
  printf "%4d%8.3f%8.3f%8.3f%7.4f%8.3f%8.3f%8.3f%7.4f", $1, x, y, z, root_of_trace(3, 5),
         degrees * $column["qx"], degrees * $column["qy"], degrees * $column["qz"],
         root_of_trace(0, 2) * degrees_per_rad
  if ($1 in true_x) {
    distance = sqrt((x - true_x[$1]) ^ 2 + (y - true_y[$1]) ^ 2 + (z - true_z[$1]) ^ 2)
    angle = angle_between($1)
    printf "%7.4f%7.4f", distance, angle
    if (distance > worst_mm) worst_mm = distance
    if (angle > worst_deg) worst_deg = angle
  }
  print ""
}
END {
  printf "\n%d poses in %d frame pairs; farthest from the truth: %.4f mm, %.4f deg\n", poses, frames,
         worst_mm, worst_deg
  if (poses == 0) exit 1
}
BEGIN { degrees_per_rad = 180 / 3.14159265358979 }
# Standard deviation of the length of the vector whose variances are cov_ii, first to last.
function root_of_trace(first, last,   i, sum) {
  for (i = first; i <= last; ++i) sum += $column["cov_" i i]
  return sqrt(sum)
}
function length_of_vector_part() {
  return sqrt($column["qx"] ^ 2 + $column["qy"] ^ 2 + $column["qz"] ^ 2)
}
# The rotation vector is the quaternion's vector part times this; qw >= 0.
function degrees_per_vector_part(w, sine) {
  return (sine > 0 ? 2 * atan2(sine, w) / sine : 2) * degrees_per_rad
}
# The vector part of true⁻¹ · measured is sin(angle / 2); acos(w) would lose all digits near 1.
function angle_between(f,   a, b, c, d, vx, vy, vz, sine) {
  a = true_qw[f]; b = -true_qx[f]; c = -true_qy[f]; d = -true_qz[f]
  vx = a * $column["qx"] + b * $column["qw"] + c * $column["qz"] - d * $column["qy"]
  vy = a * $column["qy"] - b * $column["qz"] + c * $column["qw"] + d * $column["qx"]
  vz = a * $column["qz"] + b * $column["qy"] - c * $column["qx"] + d * $column["qw"]
  sine = sqrt(vx * vx + vy * vy + vz * vz)
  return 2 * atan2(sine, sqrt(sine < 1 ? 1 - sine * sine : 0)) * degrees_per_rad
}
