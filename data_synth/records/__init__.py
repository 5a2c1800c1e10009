"""Reading and writing records of a ship and its vehicle."""

from data_synth.records.planar import PlanarRecord, planar
from data_synth.records.reading import read_record
from data_synth.records.record import Record, join, require_vehicle
from data_synth.records.writing import write_record

__all__ = ["PlanarRecord", "Record", "join", "planar", "read_record", "require_vehicle", "write_record"]
