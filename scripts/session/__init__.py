"""What scripts/session_report is made of."""
