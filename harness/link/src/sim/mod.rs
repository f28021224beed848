//! Simulated buses on one discrete-event clock.
