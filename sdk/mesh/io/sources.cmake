# Files of the readers, the writer and the repair, relative to sdk/mesh.
set(QC_MESH_IO_SOURCES
    io/number.c io/print.c io/text.c io/soup.c io/soup_finish.c io/obj.c io/off.c io/ply_header.c io/ply_plan.c
    io/ply.c io/stl.c io/read.c io/output.c io/write_obj.c io/write_off.c io/write_ply.c
    io/write_ply_header.c io/write.c
    repair/repair.c repair/edge_groups.c repair/edge_set.c repair/ear_clip.c repair/triangulate.c
    repair/weld.c repair/drop_faces.c repair/pair.c repair/edge_fit.c repair/orient.c
    repair/split.c repair/edit.c repair/zero_area.c repair/finish.c)
