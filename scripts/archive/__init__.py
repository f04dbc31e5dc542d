"""What the tools of an archive share: archive_manifest, archive_track, archive_report, archive_status. See doc/archives.md."""
